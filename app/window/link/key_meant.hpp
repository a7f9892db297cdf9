// key_meant.hpp: a key by what it types, whatever the layout of the keyboard.
#pragma once
#include <cctype>

namespace roomradar {

/// GLFW names a key by where it is on a US keyboard, and its names of keys that type something are the
/// characters that they type there, in capitals.
///
/// @param key    GLFW's
/// @param types  what it types without Shift and the like, UTF-8, as glfwGetKeyName() says it; may be null
/// @return the character that it types, in capitals, where that is one of ASCII; else, and for the keypad and
///         all keys that type nothing, `key`
inline int key_meant(int key, const char* types) {
  constexpr int kLastThatTypes = 162;  // GLFW_KEY_WORLD_2
  const bool is_ascii = types != nullptr && types[0] > ' ' && types[0] < '\x7F' && types[1] == '\0';
  return key <= kLastThatTypes && is_ascii ? std::toupper(types[0]) : key;
}

}  // namespace roomradar
