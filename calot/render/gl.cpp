#include "calot/render/gl.h"

#include <stdexcept>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace calot::render::gl {

namespace {

std::string log_of(GLuint name, bool program) {
    GLint length = 0;
    program ? glGetProgramiv(name, GL_INFO_LOG_LENGTH, &length) : glGetShaderiv(name, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length > 0 ? length : 1), '\0');
    program ? glGetProgramInfoLog(name, length, nullptr, log.data())
            : glGetShaderInfoLog(name, length, nullptr, log.data());
    return log;
}

GLuint compile(const char* program, GLenum stage, const std::string& head, const std::vector<const char*>& parts) {
    std::string source = head;
    for (const char* part : parts) source += part;
    const char* text = source.c_str();
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint good = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (!good) {
        const std::string log = log_of(shader, false);
        glDeleteShader(shader);
        throw std::runtime_error(std::string("shader ") + program + " does not compile: " + log);
    }
    return shader;
}

}  // namespace

#if defined(__SANITIZE_ADDRESS__)
DriverLeaksIgnored::DriverLeaksIgnored() {
    __lsan_disable();
}
DriverLeaksIgnored::~DriverLeaksIgnored() {
    __lsan_enable();
}
#else
DriverLeaksIgnored::DriverLeaksIgnored() = default;
DriverLeaksIgnored::~DriverLeaksIgnored() = default;
#endif

bool is_es() {
    return !epoxy_is_desktop_gl();
}

bool has_float_targets() {
    return !is_es() || epoxy_has_gl_extension("GL_EXT_color_buffer_float");
}

void check(const char* stage) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    char code[16];
    std::snprintf(code, sizeof(code), "0x%04x", error);
    throw std::runtime_error(std::string("OpenGL reports error ") + code + " in " + stage);
}

Buffer::Buffer(GLenum target) : target_(target) {
    GLuint name = 0;
    glGenBuffers(1, &name);
    object_ = Object<delete_buffer>(name);
}

void Buffer::upload(const void* data, std::size_t bytes, GLenum usage) {
    bind();
    if (bytes > capacity_) {
        capacity_ = bytes + bytes / 4;
        glBufferData(target_, static_cast<GLsizeiptr>(capacity_), nullptr, usage);
    }
    if (bytes > 0) glBufferSubData(target_, 0, static_cast<GLsizeiptr>(bytes), data);
}

VertexArray::VertexArray() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    object_ = Object<delete_vertex_array>(name);
}

void VertexArray::attribute(GLuint location, int components, std::size_t stride, std::size_t offset, GLuint divisor) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                          reinterpret_cast<const void*>(offset));
    glVertexAttribDivisor(location, divisor);
}

Program::Program(const char* name, const std::string& defines, const std::vector<const char*>& vertex,
                 const std::vector<const char*>& fragment) {
    std::string head = is_es() ? "#version 300 es\n" : "#version 330 core\n";
    head += "precision highp float;\nprecision highp int;\nprecision highp sampler3D;\n" + defines + "\n";
    const GLuint vertex_shader = compile(name, GL_VERTEX_SHADER, head, vertex);
    GLuint fragment_shader = 0;
    try {
        fragment_shader = compile(name, GL_FRAGMENT_SHADER, head, fragment);
    } catch (...) {
        glDeleteShader(vertex_shader);
        throw;
    }
    object_ = ProgramObject(glCreateProgram());
    glAttachShader(object_.name(), vertex_shader);
    glAttachShader(object_.name(), fragment_shader);
    glLinkProgram(object_.name());
    glDeleteShader(vertex_shader);
    glDeleteShader(fragment_shader);
    GLint good = GL_FALSE;
    glGetProgramiv(object_.name(), GL_LINK_STATUS, &good);
    if (!good)
        throw std::runtime_error(std::string("shader ") + name + " does not link: " + log_of(object_.name(), true));
    const GLuint block = glGetUniformBlockIndex(object_.name(), "Frame");
    if (block != GL_INVALID_INDEX) glUniformBlockBinding(object_.name(), block, 0);
}

Texture make_texture(GLenum target, GLint min_filter, GLint mag_filter, GLint wrap) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(target, name);
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, min_filter);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, mag_filter);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, wrap);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, wrap);
    if (target == GL_TEXTURE_3D) glTexParameteri(target, GL_TEXTURE_WRAP_R, wrap);
    return Texture(name);
}

void Target::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glViewport(0, 0, width, height);
}

Target make_target(int width, int height, Format format, bool with_depth) {
    Target target;
    target.width = width;
    target.height = height;
    target.colour = make_texture(GL_TEXTURE_2D, GL_LINEAR, GL_LINEAR, GL_CLAMP_TO_EDGE);
    switch (format) {
        case Format::rgba8:
            glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
            break;
        case Format::rgba16f:
            glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16F, width, height, 0, GL_RGBA, GL_HALF_FLOAT, nullptr);
            break;
        case Format::r8:
            glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
            break;
    }
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    target.framebuffer = Framebuffer(name);
    glBindFramebuffer(GL_FRAMEBUFFER, name);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.colour.name(), 0);
    if (with_depth) {
        target.depth = make_texture(GL_TEXTURE_2D, GL_NEAREST, GL_NEAREST, GL_CLAMP_TO_EDGE);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, width, height, 0, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT,
                     nullptr);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, target.depth.name(), 0);
    }
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw std::runtime_error("this OpenGL cannot draw into a frame buffer of the wanted format");
    return target;
}

}  // namespace calot::render::gl
