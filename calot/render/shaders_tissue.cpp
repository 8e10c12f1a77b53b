#include "calot/render/shaders.h"

namespace calot::render::shaders {

const char* const kTissueVertex = R"(
layout(location = 0) in vec3 a_world;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec3 a_rest;
layout(location = 3) in vec4 a_heat;      // temperature, peak [K], damage, dryness
layout(location = 4) in vec2 a_exposure;  // laid bare, blood
layout(location = 5) in vec4 a_weights;   // fat, duct, artery, gallbladder
out vec3 v_world;
out vec3 v_normal;
out vec3 v_rest;     // mm
out vec4 v_burn;     // temperature, peak [C], coagulated 0..1, dryness
out vec2 v_exposure;
out vec4 v_weights;
invariant gl_Position;
void main() {
    v_weights = a_weights;
    v_world = a_world;
#ifdef MIXED
    v_world += a_normal * (0.00012 * a_weights.z * u_round.w);   // the artery swells with each beat
#endif
    v_normal = a_normal;
    v_rest = 1000.0 * a_rest;
    v_burn = vec4(a_heat.xy - 273.15, 1.0 - exp(-a_heat.z), a_heat.w);
    v_exposure = a_exposure;
    gl_Position = u_view_projection * vec4(v_world, 1.0);
}
)";

// Colours are linear. Each look gives albedo, how much the pillows and bumps show, and how wet it is.
const char* const kTissueLooks = R"(
struct Samples {
    float border; // distance to the septum between lobules, see noise.h
    float cells;  // distance to the border of fine cells
    float pillow; // height of lobules, 0..1
    vec4 base;
    vec4 fine;    // smooth noise at a smaller scale
    float vein;   // 0..1, branching lines
    float vein_fine;
};
struct Look {
    vec3 albedo;
    float pillow; // height of lobules [mm]
    float bump;   // height of fine bumps [mm]
    float rough;
    float coat;
    float coat_rough;
};

// Level lines of smooth noise wander and branch as vessels do; `width` in units of the noise.
float level_line(float value, float width) { return 1.0 - smoothstep(0.05 * width, width, abs(value - 0.5)); }

Look fat_look(Samples s) {
    Look look;
    float septum = 1.0 - smoothstep(0.0, 0.34, s.border + 0.22 * (s.fine.r - 0.5));
    vec3 deep = vec3(0.82, 0.50, 0.13), pale = vec3(0.93, 0.75, 0.38);
    float tone = clamp(0.20 + 0.45 * s.pillow + 1.7 * (s.base.r - 0.5), 0.0, 1.0);
    look.albedo = mix(deep, pale, tone);
    look.albedo = mix(look.albedo, vec3(0.98, 0.86, 0.58), 0.45 * smoothstep(0.50, 0.80, s.fine.a));
    look.albedo = mix(look.albedo, vec3(0.80, 0.42, 0.20), 0.40 * septum);
    look.albedo = mix(look.albedo, vec3(0.80, 0.36, 0.24), 0.35 * smoothstep(0.55, 0.75, s.base.b));   // flushed patches
    look.albedo = mix(look.albedo, vec3(0.36, 0.022, 0.022), 0.80 * s.vein + 0.55 * s.vein_fine);
    look.pillow = 0.42;
    look.bump = 0.075;
    look.rough = 0.40;
    look.coat = 1.5;
    look.coat_rough = 0.14;
    return look;
}
Look duct_look(Samples s) {
    Look look;
    look.albedo = mix(vec3(0.60, 0.58, 0.36), vec3(0.80, 0.76, 0.58), clamp(0.5 + 1.6 * (s.base.r - 0.5), 0.0, 1.0));
    look.albedo = mix(look.albedo, vec3(0.62, 0.12, 0.09), 0.5 * s.vein_fine);
    look.pillow = 0.03;
    look.bump = 0.07;
    look.rough = 0.38;
    look.coat = 1.0;
    look.coat_rough = 0.16;
    return look;
}
Look artery_look(Samples s, float pulse) {
    Look look;
    look.albedo = mix(vec3(0.60, 0.13, 0.10), vec3(0.80, 0.33, 0.27), clamp(0.5 + 1.8 * (s.base.r - 0.5), 0.0, 1.0));
    look.albedo *= mix(vec3(1.0, 0.92, 0.92), vec3(1.18, 1.0, 1.0), pulse);
    look.pillow = 0.02;
    look.bump = 0.06;
    look.rough = 0.38;
    look.coat = 1.0;
    look.coat_rough = 0.16;
    return look;
}
Look gallbladder_look(Samples s) {
    Look look;
    float tone = clamp(0.5 + 1.5 * (s.base.r - 0.5), 0.0, 1.0);
    look.albedo = mix(vec3(0.22, 0.28, 0.22), vec3(0.40, 0.45, 0.35), tone);
    look.albedo = mix(look.albedo, vec3(0.62, 0.55, 0.33), 0.40 * smoothstep(0.45, 0.85, s.base.b));   // fat shining through
    look.albedo = mix(look.albedo, vec3(0.47, 0.09, 0.07), 0.8 * s.vein + 0.5 * s.vein_fine);
    look.pillow = 0.05;
    look.bump = 0.06;
    look.rough = 0.33;
    look.coat = 1.0;
    look.coat_rough = 0.15;
    return look;
}
Look liver_look(Samples s) {
    Look look;
    float mottle = clamp(0.5 + 0.7 * (s.base.r - 0.5) + 0.9 * (s.fine.r - 0.5), 0.0, 1.0);
    look.albedo = mix(vec3(0.150, 0.034, 0.026), vec3(0.25, 0.070, 0.048), mottle);
    look.albedo = mix(look.albedo, vec3(0.36, 0.13, 0.085), 0.22 * (1.0 - smoothstep(0.0, 0.25, s.cells)));
    look.pillow = 0.03;
    look.bump = 0.06;
    look.rough = 0.36;
    look.coat = 1.5;
    look.coat_rough = 0.20;
    return look;
}
Look peritoneum_look(Samples s) {
    Look look;
    float tone = clamp(0.5 + 1.6 * (s.base.r - 0.5), 0.0, 1.0);
    look.albedo = mix(vec3(0.58, 0.22, 0.16), vec3(0.80, 0.46, 0.35), tone);
    look.albedo = mix(look.albedo, vec3(0.85, 0.62, 0.28), 0.55 * smoothstep(0.42, 0.85, s.base.b));   // fat beneath
    look.albedo = mix(look.albedo, vec3(0.50, 0.06, 0.05), 0.75 * s.vein + 0.5 * s.vein_fine);
    look.pillow = 0.10;
    look.bump = 0.09;
    look.rough = 0.36;
    look.coat = 1.0;
    look.coat_rough = 0.17;
    return look;
}
Look bowel_look(Samples s) {
    Look look = peritoneum_look(s);
    look.albedo = mix(look.albedo, vec3(0.82, 0.50, 0.42), 0.6);
    return look;
}

Look mixed(Look a, Look b, float t) {
    return Look(mix(a.albedo, b.albedo, t), mix(a.pillow, b.pillow, t), mix(a.bump, b.bump, t), mix(a.rough, b.rough, t),
                mix(a.coat, b.coat, t), mix(a.coat_rough, b.coat_rough, t));
}
)";

const char* const kTissueFragment = R"(
in vec3 v_world;
in vec3 v_normal;
in vec3 v_rest;
in vec4 v_burn;
in vec2 v_exposure;
in vec4 v_weights;
uniform sampler3D u_lobules;
uniform sampler3D u_smooth;
uniform sampler3D u_bump;
uniform sampler2D u_occlusion;
out vec4 o_colour;

vec3 slope_of(vec3 texel) { return 2.0 * texel - 1.0; }

float pillow_height(float border) {
    float rest = 1.0 - min(1.0, border * (0.5 / PILLOW_WIDTH));
    return 1.0 - rest * rest;
}

// Colours of maps, of albedo: their legends are in apps/calot/debrief_page.cpp.
vec3 heat_colour(float celsius) {
    vec3 c = vec3(0.50, 0.50, 0.52);
    c = mix(c, vec3(0.95, 0.80, 0.25), smoothstep(39.0, 48.0, celsius));
    c = mix(c, vec3(0.90, 0.35, 0.05), smoothstep(50.0, 62.0, celsius));
    c = mix(c, vec3(0.70, 0.02, 0.03), smoothstep(66.0, 95.0, celsius));
    return mix(c, vec3(0.10, 0.00, 0.06), smoothstep(110.0, 220.0, celsius));
}
// `coagulated` = 1 - exp(-Omega); Omega = 1 is 0.63.
vec3 injury_colour(float coagulated) {
    vec3 c = vec3(0.50, 0.50, 0.52);
    c = mix(c, vec3(0.95, 0.80, 0.25), smoothstep(0.02, 0.20, coagulated));
    c = mix(c, vec3(0.85, 0.05, 0.20), smoothstep(0.52, 0.64, coagulated));
    return mix(c, vec3(0.30, 0.00, 0.25), smoothstep(0.93, 0.999, coagulated));
}

void main() {
    vec3 p = v_rest;

    Samples s;
    s.base = texture(u_smooth, p / 26.0);
    vec3 warped = p + 6.0 * (s.base.rgb - 0.5);
#if QUALITY > 0
    s.fine = texture(u_smooth, p.yzx / 8.0);
    warped += 1.8 * (s.fine.rgb - 0.5);
#else
    s.fine = s.base.argb;
#endif
    vec4 lobule = texture(u_lobules, warped / 25.0);
    vec4 bump = texture(u_bump, p / 10.0);
    // Slopes for 1 mm of height, per mm.
    vec3 lobules = slope_of(lobule.rgb) * (PILLOW_SLOPE / 25.0);
    vec3 bumps = slope_of(bump.rgb) * (BUMP_SLOPE / 10.0);
    s.border = lobule.a;
    s.pillow = pillow_height(lobule.a);
    s.cells = bump.a;
#if QUALITY > 0
    vec4 small = texture(u_bump, p.zxy / 4.1);
    bumps += 0.45 * slope_of(small.rgb) * (BUMP_SLOPE / 4.1);
    vec4 lobes = texture(u_lobules, (warped.yzx + 3.0 * (s.fine.rgb - 0.5)) / 9.7);
    lobules += 0.22 * slope_of(lobes.rgb).zxy * (PILLOW_SLOPE / 9.7);
    s.pillow = mix(s.pillow, pillow_height(lobes.a), 0.3);
#endif
    // Vessels: long wandering lines with thin branches near them.
#if QUALITY > 0
    vec4 course = texture(u_smooth, (p.zxy + 3.0 * (s.base.gbr - 0.5)) / 47.0);
    float off = course.g + 0.10 * (s.base.b - 0.5) - 0.5;
    float trunk = smoothstep(0.40, 0.62, course.b);
    s.vein = level_line(off + 0.5, 0.007 + 0.009 * trunk) * smoothstep(0.05, 0.4, trunk);
    float near = trunk * (1.0 - smoothstep(0.05, 0.24, abs(off)));
    s.vein_fine = level_line(s.base.g + 0.08 * (s.fine.r - 0.5), 0.020) * near * smoothstep(0.40, 0.55, s.base.b) +
                  0.5 * level_line(s.fine.g, 0.03) * near * smoothstep(0.50, 0.62, s.fine.b);
    s.vein_fine = min(s.vein_fine, 1.0 - s.vein);
#else
    s.vein = level_line(s.base.g, 0.014) * smoothstep(0.45, 0.65, s.base.b);
    s.vein_fine = 0.0;
#endif

    float pulse = u_round.w;
#ifdef MIXED
    vec4 w = v_weights / max(dot(v_weights, vec4(1.0)), 1e-4);
    // Borders wander a little, so that tissues meet along an uneven line.
    w = clamp(w + 0.35 * (s.fine.r - 0.5) * w * (1.0 - w), 0.0, 1.0);
    Look look = fat_look(s);
    look = mixed(look, duct_look(s), smoothstep(0.25, 0.75, w.y));
    look = mixed(look, artery_look(s, pulse), smoothstep(0.25, 0.75, w.z));
    look = mixed(look, gallbladder_look(s), smoothstep(0.25, 0.75, w.w));
    float fatness = 1.0 - smoothstep(0.25, 0.75, w.y + w.z + w.w);
#else
    Look look = ORGAN_LOOK;
#endif
        vec3 glow = vec3(0.0);
#ifdef MIXED
    // --- What burning leaves behind. Ragged by noise: steps follow the peak temperature shifted by up to 20 K.
    float ragged = 60.0 * (s.base.a - 0.5) + 40.0 * (s.fine.r - 0.5);
    float peak = v_burn.y + clamp((v_burn.y - 45.0) / 40.0, 0.0, 1.0) * ragged;
    // The collagen of vessels keeps its colour longer than the protein between fat cells.
    float blanched = max(smoothstep(52.0, 88.0, peak), smoothstep(0.3, 0.95, v_burn.z)) * mix(0.4, 1.0, fatness);
    float browned = smoothstep(125.0, 200.0, peak);
    float charred = smoothstep(215.0, 285.0, peak);
    // Laid bare: raw, frothy, wet, with thin pale strands.
    float bare = smoothstep(0.15, 0.65, v_exposure.x);
    float froth = 1.0 - smoothstep(0.02, 0.30, s.cells);
    float strand = level_line(s.fine.b, 0.05) * smoothstep(0.45, 0.6, s.base.a);
    vec3 raw = look.albedo * mix(vec3(0.95, 0.74, 0.52), vec3(0.92, 0.46, 0.34), smoothstep(0.42, 0.60, s.fine.r));
    raw = mix(raw, vec3(0.90, 0.80, 0.60), 0.16 * froth + 0.5 * strand);
    look.albedo = mix(look.albedo, raw, bare * (0.15 + 0.85 * fatness));   // vessels are only stripped
    look.pillow *= 1.0 - 0.75 * bare;
    look.bump += 0.14 * bare * (0.3 + 0.7 * fatness);
    look.coat_rough = mix(look.coat_rough, 0.15, bare);

    vec3 pale = mix(vec3(0.64, 0.53, 0.37), vec3(0.76, 0.69, 0.56), clamp(0.5 + 2.0 * (s.fine.a - 0.5) + 1.2 * (s.base.a - 0.5), 0.0, 1.0));
    look.albedo = mix(look.albedo, pale, (0.55 + 0.35 * s.base.a) * blanched);
    vec3 brown = mix(vec3(0.34, 0.145, 0.035), vec3(0.13, 0.045, 0.014), smoothstep(150.0, 230.0, peak + 60.0 * (s.fine.g - 0.5)));
    look.albedo = mix(look.albedo, brown, 0.92 * browned);
    // The face of a cut was against the hot gas of what went: a skin much thinner than a hexel is singed.
    float singed = bare * smoothstep(82.0, 100.0, v_burn.y) * smoothstep(0.34, 0.62, 0.5 * s.base.a + 0.5 * s.fine.g + 0.10 * (0.5 - s.cells));
    look.albedo = mix(look.albedo, mix(vec3(0.48, 0.24, 0.08), vec3(0.27, 0.11, 0.035), smoothstep(0.48, 0.80, s.fine.g)), 0.75 * singed * mix(0.45, 1.0, fatness) * (1.0 - browned));
    float crack = 1.0 - smoothstep(0.03, 0.16, s.cells);
    float ash = smoothstep(0.64, 0.74, s.fine.a) * smoothstep(0.5, 0.65, s.base.a);
    vec3 char_colour = mix(vec3(0.016, 0.012, 0.010), vec3(0.075, 0.038, 0.022), 0.7 * crack);
    char_colour = mix(char_colour, vec3(0.34, 0.31, 0.28), 0.7 * ash);
    look.albedo = mix(look.albedo, char_colour, charred);
    float dry = max(max(0.40 * blanched, 0.75 * browned), max(0.93 * charred, 0.8 * v_burn.w));
    look.coat *= 1.0 - dry;
    look.rough = mix(look.rough, 0.62, dry);
    look.coat_rough = mix(look.coat_rough, 0.36, dry);
    look.bump += 0.16 * charred + 0.05 * browned;
    look.pillow *= 1.0 - 0.6 * charred;
    // Blood over all of it, thicker in creases, with an edge that the surface breaks up.
    if (v_exposure.y > 0.004) {
        float film = v_exposure.y * (1.15 - 0.5 * s.pillow) + 0.10 * (s.fine.r - 0.5) * (1.0 - v_exposure.y);
        float cover = smoothstep(0.03, 0.30, film);
        vec3 blood = mix(vec3(0.30, 0.006, 0.006), vec3(0.10, 0.002, 0.003), smoothstep(0.15, 0.9, film));
        look.albedo = mix(look.albedo, blood, 0.93 * cover);
        look.bump *= 1.0 - 0.75 * cover;
        look.pillow *= 1.0 - 0.45 * cover;
        look.coat = mix(look.coat, 1.5, cover);
        look.coat_rough = mix(look.coat_rough, 0.10, cover);
    }
    // Embers, only while hot.
    float ember = smoothstep(230.0, 330.0, v_burn.x) * (0.25 + crack);
    glow = vec3(1.0, 0.22, 0.03) * 0.5 * ember;
#endif
    if (u_counts.x != 0) {
        // A map instead of a picture: no glow, little shine, colours that can be read off.
#ifdef MIXED
        look.albedo = u_counts.x == 1 ? heat_colour(v_burn.y) : injury_colour(v_burn.z);
#else
        look.albedo = vec3(0.16, 0.17, 0.19);
#endif
        glow = vec3(0.0);
        look.coat *= 0.15;
        look.rough = 0.7;
        look.bump *= 0.3;
    }
    vec3 up = normalize(v_normal);
    vec3 toward = normalize(u_eye.xyz - v_world);
    vec3 tilt = look.pillow * lobules + look.bump * bumps;
    tilt -= dot(tilt, up) * up;
    Material m;
    m.normal = normalize(up - 0.8 * tilt);
    m.coat_normal = normalize(up - 0.75 * look.pillow * (lobules - dot(lobules, up) * up) - 0.55 * look.bump * (bumps - dot(bumps, up) * up));
    m.albedo = look.albedo;
    m.rough = look.rough;
    m.specular = 0.035;
    m.coat = look.coat;
    m.coat_rough = look.coat_rough;
    m.wrap = vec3(0.42, 0.22, 0.12);
    // Thin at grazing view: light that went through comes back warm.
    float edge = 1.0 - clamp(dot(up, toward), 0.0, 1.0);
    m.albedo *= mix(vec3(1.0), vec3(1.04, 0.91, 0.82), edge * edge);
    m.occlusion = mix(0.80, 1.0, s.pillow * min(1.0, 2.4 * look.pillow) + 1.0 - min(1.0, 2.4 * look.pillow));
#if QUALITY > 0
    m.occlusion *= texture(u_occlusion, gl_FragCoord.xy * u_pixels.zw).r;
#endif
    vec3 colour = light_material(m, v_world, true) + glow;
    o_colour = vec4(encode(colour), 1.0);
}
)";

}  // namespace calot::render::shaders
