// gl_program.hpp: compile and link shaders.
#pragma once
#include <initializer_list>

namespace roomradar {

/// One stage of a program.
struct ShaderSource {
  unsigned stage = 0;  ///< GL_VERTEX_SHADER and so on
  /// GLSL, in pieces that are put together.
  std::initializer_list<const char*> pieces;
};

/// @param name  for messages
/// @return the GL name of the program, to be freed by glDeleteProgram; the context must be current
/// @throws Error with the compiler's log
unsigned make_program(const char* name, std::initializer_list<ShaderSource> shaders);
/// The same of one vertex and one fragment shader.
unsigned make_program(const char* name, const char* vertex_shader, const char* fragment_shader);

}  // namespace roomradar
