// Tables that take longer to make than to use once: the last few that a thread has asked for.
#pragma once

#include <array>
#include <memory>

namespace vines {

/// A pure function of a few numbers, remembered for the last numbers that it was asked for. One for
/// each thread (thread_local): no lock, and what a thread gets does not depend on the others.
template <class Key, class Table, std::size_t most = 4>
class LastUsed {
public:
    template <class Make>
    std::shared_ptr<const Table> get(const Key& key, Make make) {
        for (const Entry& e : entries_)
            if (e.table && e.key == key) return e.table;
        Entry& oldest = entries_[next_++ % most];
        oldest = {key, std::make_shared<const Table>(make())};
        return oldest.table;
    }

private:
    struct Entry {
        Key key;
        std::shared_ptr<const Table> table;
    };
    std::array<Entry, most> entries_;
    std::size_t next_ = 0;
};

}  // namespace vines
