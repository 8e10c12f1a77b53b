#pragma once
// Thin owners of OpenGL objects, on what OpenGL 3.3 core and OpenGL ES 3.0 have in common.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

namespace calot::render::gl {

/// True on OpenGL ES (and WebGL 2), false on desktop OpenGL.
bool is_es();
/// True when RGBA16F can be drawn into: always on desktop OpenGL, an extension on ES.
bool has_float_targets();
/// Throws std::runtime_error naming `stage` and the error, when OpenGL has one to report.
void check(const char* stage);

/// Drivers keep a little of their own until the process ends (Mesa 22.3: some hundred bytes of every context). While
/// this lives, the leak check of our code leaves out what is allocated.
class DriverLeaksIgnored {
  public:
    DriverLeaksIgnored();
    ~DriverLeaksIgnored();
};

/// One GL object; `Deleter` is a function of its name.
template <void (*Deleter)(GLuint)>
class Object {
  public:
    Object() = default;
    explicit Object(GLuint name) : name_(name) {}
    ~Object() { reset(); }
    Object(Object&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Object& operator=(Object&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    GLuint name() const { return name_; }
    explicit operator bool() const { return name_ != 0; }
    void reset() {
        if (name_ != 0) Deleter(name_);
        name_ = 0;
    }

  private:
    GLuint name_ = 0;
};

inline void delete_buffer(GLuint name) {
    glDeleteBuffers(1, &name);
}
inline void delete_texture(GLuint name) {
    glDeleteTextures(1, &name);
}
inline void delete_framebuffer(GLuint name) {
    glDeleteFramebuffers(1, &name);
}
inline void delete_vertex_array(GLuint name) {
    glDeleteVertexArrays(1, &name);
}
inline void delete_program(GLuint name) {
    glDeleteProgram(name);
}

using Texture = Object<delete_texture>;
using Framebuffer = Object<delete_framebuffer>;
using ProgramObject = Object<delete_program>;

class Buffer {
  public:
    explicit Buffer(GLenum target);
    void bind() const { glBindBuffer(target_, object_.name()); }
    /// Replaces the contents; storage grows, never shrinks.
    void upload(const void* data, std::size_t bytes, GLenum usage = GL_STREAM_DRAW);
    GLuint name() const { return object_.name(); }

  private:
    GLenum target_;
    Object<delete_buffer> object_;
    std::size_t capacity_ = 0;
};

class VertexArray {
  public:
    VertexArray();
    void bind() const { glBindVertexArray(object_.name()); }
    /// Float attribute in the bound array, from the bound GL_ARRAY_BUFFER.
    static void attribute(GLuint location, int components, std::size_t stride, std::size_t offset, GLuint divisor = 0);

  private:
    Object<delete_vertex_array> object_;
};

class Program {
  public:
    /// Compiles and links; throws std::runtime_error with the compiler's log. `defines` are lines "#define ...".
    /// Uniform block "Frame" is bound to point 0; samplers are set by sampler().
    Program(const char* name, const std::string& defines, const std::vector<const char*>& vertex,
            const std::vector<const char*>& fragment);
    void use() const { glUseProgram(object_.name()); }
    /// Lets a sampler read from a texture unit (the program must be in use). Unknown names are ignored.
    void sampler(const char* name, int unit) const { glUniform1i(location(name), unit); }
    GLint location(const char* name) const { return glGetUniformLocation(object_.name(), name); }

  private:
    ProgramObject object_;
};

Texture make_texture(GLenum target, GLint min_filter, GLint mag_filter, GLint wrap);

/// A colour texture with its frame buffer, and a depth texture where wanted.
struct Target {
    int width = 0;
    int height = 0;
    Texture colour;
    Texture depth;
    Framebuffer framebuffer;

    void bind() const;
};
enum class Format { rgba8, rgba16f, r8 };
Target make_target(int width, int height, Format format, bool with_depth);

}  // namespace calot::render::gl
