// message_log.cpp: sorts and selects messages.
#include "app/sources/containers/message_log.hpp"

#include <algorithm>

namespace roomradar {

std::string ros1_type_name(std::string type) {
  const std::size_t msg = type.find("/msg/");
  return msg == std::string::npos ? type : type.erase(msg, 4);
}

std::uint32_t number_of_topic(const MessageTopic& topic, std::vector<MessageTopic>& topics) {
  const auto found = std::find_if(topics.begin(), topics.end(),
                                  [&](const MessageTopic& each) { return each.name == topic.name; });
  const auto number = static_cast<std::uint32_t>(found - topics.begin());
  if (found == topics.end()) topics.push_back(topic);
  return number;
}

std::vector<MessageEntry> messages_of(const MessageLog& log, std::uint32_t topic) {
  std::vector<MessageEntry> entries;
  for (const MessageEntry& entry : log.messages)
    if (entry.topic == topic) entries.push_back(entry);
  return entries;
}

void sort_by_stamp(MessageLog& log) {
  std::stable_sort(log.messages.begin(), log.messages.end(),
                   [](const MessageEntry& a, const MessageEntry& b) { return a.stamp_s < b.stamp_s; });
}

}  // namespace roomradar
