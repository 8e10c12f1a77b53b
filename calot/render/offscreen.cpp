// A context without a window: EGL on Mesa's surfaceless platform where there is one, else on the default display with
// a one-pixel surface. Desktop OpenGL 3.3 core first, OpenGL ES 3.0 otherwise.

#include <cstdio>
#include <cstring>
#include <stdexcept>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include "calot/render/gl.h"
#include "calot/render/renderer.h"

namespace calot::render {

struct OffscreenContext::Impl {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    EGLSurface surface = EGL_NO_SURFACE;

    ~Impl() {
        if (display == EGL_NO_DISPLAY) return;
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (surface != EGL_NO_SURFACE) eglDestroySurface(display, surface);
        if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
        eglTerminate(display);
    }
};

namespace {

std::string egl_code() {
    char code[16];
    std::snprintf(code, sizeof(code), "0x%04x", static_cast<unsigned>(eglGetError()));
    return code;
}

bool has_word(const char* list, const char* word) {
    return list != nullptr && std::strstr(list, word) != nullptr;
}

EGLDisplay open_display() {
    // The extensions of the client, asked for without a display.
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (has_word(client, "EGL_EXT_platform_base") && has_word(client, "EGL_MESA_platform_surfaceless")) {
        const EGLDisplay display =
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
    }
    const EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
    throw std::runtime_error("cannot open an EGL display (" + egl_code() +
                             "): pictures need EGL with OpenGL; on Debian install libegl1 and libgl1-mesa-dri");
}

EGLContext create_context(EGLDisplay display, bool es, EGLConfig& config) {
    if (!eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API)) return EGL_NO_CONTEXT;
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                             es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT, EGL_NONE};
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) return EGL_NO_CONTEXT;
    const EGLint desktop[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    const EGLint embedded[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
    return eglCreateContext(display, config, EGL_NO_CONTEXT, es ? embedded : desktop);
}

}  // namespace

OffscreenContext::OffscreenContext(Api api) : impl_(std::make_unique<Impl>()) {
    const gl::DriverLeaksIgnored ignored;
    impl_->display = open_display();
    EGLConfig config = nullptr;
    if (api != Api::opengl_es) impl_->context = create_context(impl_->display, false, config);
    if (impl_->context == EGL_NO_CONTEXT && api != Api::opengl)
        impl_->context = create_context(impl_->display, true, config);
    if (impl_->context == EGL_NO_CONTEXT)
        throw std::runtime_error("EGL offers neither OpenGL 3.3 core nor OpenGL ES 3.0 (" + egl_code() +
                                 "); on Debian install libgl1-mesa-dri");
    if (!has_word(eglQueryString(impl_->display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
        const EGLint size[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
        impl_->surface = eglCreatePbufferSurface(impl_->display, config, size);
    }
    if (!eglMakeCurrent(impl_->display, impl_->surface, impl_->surface, impl_->context))
        throw std::runtime_error("EGL cannot make its context current (" + egl_code() + ")");
}

OffscreenContext::~OffscreenContext() = default;

std::string OffscreenContext::description() const {
    auto text = [](GLenum name) {
        const GLubyte* value = glGetString(name);
        return std::string(value != nullptr ? reinterpret_cast<const char*>(value) : "?");
    };
    return text(GL_VENDOR) + ", " + text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

}  // namespace calot::render
