// gl_program.hpp: compiles and links shader programs.
#pragma once
#include <initializer_list>

namespace roomradar {

/// One shader stage of a program.
struct ShaderSource {
  unsigned stage = 0;  ///< GL_VERTEX_SHADER, ...
  /// GLSL in pieces, which are concatenated.
  std::initializer_list<const char*> pieces;
};

/// @param name  for error messages
/// @return GL name of the program, to be freed with glDeleteProgram; the context must be current
/// @throws Error with the compiler's log
unsigned make_program(const char* name, std::initializer_list<ShaderSource> shaders);
/// Makes a program of one vertex and one fragment shader.
unsigned make_program(const char* name, const char* vertex_shader, const char* fragment_shader);

}  // namespace roomradar
