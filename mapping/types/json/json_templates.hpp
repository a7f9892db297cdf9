// json_templates.hpp: declares the templates of nlohmann's library that read and write JSON text, which are
// thus compiled only once.
//
// They take 3 s to compile in every source that instantiates them. The precompiled header includes this one;
// without it sources compile their own.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace nlohmann::detail {

using TextAdapter = iterator_input_adapter<std::string::const_iterator>;

extern template class serializer<json>;
extern template class serializer<ordered_json>;
extern template class lexer<json, TextAdapter>;
extern template class lexer<ordered_json, TextAdapter>;
extern template class parser<json, TextAdapter>;
extern template class parser<ordered_json, TextAdapter>;

}  // namespace nlohmann::detail
