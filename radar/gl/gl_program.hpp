// gl_program.hpp: compiles and links shader programs.
#pragma once
#include <initializer_list>

namespace roomradar {

/// One shader stage of a program.
struct ShaderSource {
  /// Stage, for example GL_VERTEX_SHADER.
  unsigned stage = 0;
  /// Pieces of GLSL source, concatenated in this order.
  std::initializer_list<const char*> pieces;
};

/// The context must be current.
/// @param name  name of the program for error messages
/// @return GL name of the program; the caller frees it with glDeleteProgram
/// @throws Error with the compiler's log
unsigned make_program(const char* name, std::initializer_list<ShaderSource> shaders);
/// Makes a program of one vertex and one fragment shader.
unsigned make_program(const char* name, const char* vertex_shader, const char* fragment_shader);

}  // namespace roomradar
