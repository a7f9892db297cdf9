// message_log.cpp: order and selection.
#include "app/sources/containers/message_log.hpp"

#include <algorithm>

namespace roomradar {

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
