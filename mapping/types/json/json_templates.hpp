// json_templates.hpp: explicit instantiation declarations of nlohmann's templates that read and write JSON
// text, so that the templates are compiled only once.
//
// The templates take 3 s to compile in every source file that instantiates them. The precompiled header
// includes this header. Source files built without the precompiled header instantiate the templates
// themselves.
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
