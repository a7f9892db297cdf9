// gl_program.cpp: shaders in, program out, or the compiler's words.
#include "radar/gl_program.hpp"

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

#include <array>
#include <string>

#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

GLuint make_shader(const char* name, GLenum stage, const char* source) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  std::array<char, 2048> log{};
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  glDeleteShader(shader);
  throw Error(std::string("the graphics driver does not compile the ") +
              (stage == GL_VERTEX_SHADER ? "vertex" : "fragment") + " shader \"" + name +
              "\": " + log.data());
}

}  // namespace

unsigned make_program(const char* name, const char* vertex_shader, const char* fragment_shader) {
  const GLuint vertex = make_shader(name, GL_VERTEX_SHADER, vertex_shader);
  GLuint fragment = 0;
  try {
    fragment = make_shader(name, GL_FRAGMENT_SHADER, fragment_shader);
  } catch (...) {
    glDeleteShader(vertex);
    throw;
  }
  const GLuint program = glCreateProgram();
  for (const GLuint shader : {vertex, fragment}) {
    glAttachShader(program, shader);
    glDeleteShader(shader);  // goes with the program
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

}  // namespace roomradar
