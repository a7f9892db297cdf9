// key_meant.hpp: maps a key to the character that it types, for any keyboard layout.
#pragma once
#include <cctype>

namespace roomradar {

/// GLFW identifies a key by its position on a US keyboard. If a US keyboard types a character with that key,
/// the key code is the character in uppercase.
///
/// @param key    GLFW's key code
/// @param types  UTF-8 text typed by the key without modifiers, as from glfwGetKeyName(); may be null
/// @return the typed character in uppercase if it is ASCII. `key` for other characters, for the keypad, and
///         for keys that type nothing
inline int key_meant(int key, const char* types) {
  constexpr int kLastThatTypes = 162;  // GLFW_KEY_WORLD_2, the last key that types a character
  const bool is_ascii = types != nullptr && types[0] > ' ' && types[0] < '\x7F' && types[1] == '\0';
  return key <= kLastThatTypes && is_ascii ? std::toupper(types[0]) : key;
}

}  // namespace roomradar
