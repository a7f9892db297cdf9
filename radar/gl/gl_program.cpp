// gl_program.cpp: compiles shaders, links programs, reports the compiler's log.
#include "radar/gl/gl_program.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <array>
#include <string>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

const char* name_of(GLenum stage) {
  switch (stage) {
    case GL_VERTEX_SHADER:
      return "vertex";
    case GL_GEOMETRY_SHADER:
      return "geometry";
    case GL_FRAGMENT_SHADER:
      return "fragment";
    default:
      return "compute";
  }
}

GLuint make_shader(const char* name, const ShaderSource& source) {
  const GLuint shader = glCreateShader(source.stage);
  glShaderSource(shader, static_cast<GLsizei>(source.pieces.size()), source.pieces.begin(), nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  std::array<char, 2048> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteShader(shader);
  throw Error(std::string("the graphics driver does not compile the ") + name_of(source.stage) +
              " shader \"" + name + "\": " + log.data());
}

}  // namespace

unsigned make_program(const char* name, std::initializer_list<ShaderSource> shaders) {
  const GLuint program = glCreateProgram();
  try {
    for (const ShaderSource& source : shaders) {
      const GLuint shader = make_shader(name, source);
      glAttachShader(program, shader);
      glDeleteShader(shader);  // freed with the program
    }
  } catch (...) {
    glDeleteProgram(program);
    throw;
  }
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return program;
  std::array<char, 2048> log{};
  glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteProgram(program);
  throw Error(std::string("the graphics driver does not link the program \"") + name + "\": " + log.data());
}

unsigned make_program(const char* name, const char* vertex_shader, const char* fragment_shader) {
  return make_program(name, {{GL_VERTEX_SHADER, {vertex_shader}}, {GL_FRAGMENT_SHADER, {fragment_shader}}});
}

}  // namespace roomradar
