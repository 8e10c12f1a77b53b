#pragma once
// The shaders' text. GLSL 3.30 and GLSL ES 3.00 alike; gl::Program puts the version line and defines before it.
// QUALITY is 0, 1 or 2; HDR says that the scene is drawn into RGBA16F (else square roots into RGBA8).

namespace calot::render::shaders {

extern const char* const kFrame;  ///< uniform block, shared by all
extern const char* const kLight;  ///< scope light, shadows of the instrument, two-lobe reflection
extern const char* const kTissueVertex;
extern const char* const kTissueLooks;  ///< colours and bumps of each tissue, burning
extern const char* const kTissueFragment;
extern const char* const kDepthFragment;
extern const char* const kInstrumentVertex;
extern const char* const kInstrumentFragment;
extern const char* const kSmokeVertex;
extern const char* const kSmokeFragment;
extern const char* const kDropVertex;
extern const char* const kDropFragment;
extern const char* const kSparkVertex;
extern const char* const kSparkFragment;
extern const char* const kMaskVertex;    ///< the black ring around the round image, nearest of all
extern const char* const kScreenVertex;  ///< one triangle over the whole target
extern const char* const kOcclusionFragment;
extern const char* const kOcclusionBlurFragment;
extern const char* const kBrightFragment;
extern const char* const kBlurFragment;
extern const char* const kComposeFragment;
extern const char* const kFinishFragment;

}  // namespace calot::render::shaders
