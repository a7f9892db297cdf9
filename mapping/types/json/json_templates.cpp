// json_templates.cpp: the instantiations of nlohmann's templates.
#include "mapping/types/json/json_templates.hpp"

namespace nlohmann::detail {

template class serializer<json>;
template class serializer<ordered_json>;
template class lexer<json, TextAdapter>;
template class lexer<ordered_json, TextAdapter>;
template class parser<json, TextAdapter>;
template class parser<ordered_json, TextAdapter>;

}  // namespace nlohmann::detail
