// gl_program.hpp: compile and link one vertex and one fragment shader.
#pragma once

namespace roomradar {

/// @param name  for messages
/// @return the GL name of the program, to be freed by glDeleteProgram; the context must be current
/// @throws Error with the compiler's log
unsigned make_program(const char* name, const char* vertex_shader, const char* fragment_shader);

}  // namespace roomradar
