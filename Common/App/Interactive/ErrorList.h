// What went wrong, until the user has read it and beyond.
#pragma once
#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>

#include "Common/App/Interactive/InteractiveState.h"

namespace rt::app {

struct ErrorEntry {
    std::string text;
    ErrorSource source = ErrorSource::Other; // the field that it stands at
    std::uint32_t count = 1;                 // how often it came in a row
    bool isRead = false;                     // dismissed: it is in the list only
};

class ErrorList {
  public:
    static constexpr std::size_t kMax = 50;

    void add(const std::string& text, ErrorSource source) {
        if (!entries_.empty() && entries_.back().text == text) {
            ++entries_.back().count;
            entries_.back().isRead = false;
            return;
        }
        entries_.push_back({text, source});
        if (entries_.size() > kMax) entries_.pop_front();
    }
    // The latest that is not read yet, of any or of one source; null: none.
    const ErrorEntry* unread() const {
        return findUnread([](const ErrorEntry&) { return true; });
    }
    const ErrorEntry* unread(ErrorSource source) const {
        return findUnread([source](const ErrorEntry& entry) { return entry.source == source; });
    }
    std::size_t unreadCount() const {
        return static_cast<std::size_t>(
            std::count_if(entries_.begin(), entries_.end(), [](const ErrorEntry& entry) { return !entry.isRead; }));
    }
    void dismiss(const ErrorEntry& one) {
        for (ErrorEntry& entry : entries_)
            if (&entry == &one) entry.isRead = true;
    }
    void dismiss(ErrorSource source) { // which has become right
        for (ErrorEntry& entry : entries_)
            if (entry.source == source) entry.isRead = true;
    }
    void dismissAll() {
        for (ErrorEntry& entry : entries_) entry.isRead = true;
    }
    void clear() { entries_.clear(); }
    const std::deque<ErrorEntry>& all() const { return entries_; } // the oldest first

  private:
    template <class Test>
    const ErrorEntry* findUnread(Test test) const {
        const auto at = std::find_if(entries_.rbegin(), entries_.rend(),
                                     [&](const ErrorEntry& entry) { return !entry.isRead && test(entry); });
        return at == entries_.rend() ? nullptr : &*at;
    }

    std::deque<ErrorEntry> entries_;
};

} // namespace rt::app
