#pragma once
// operator new of the test program, as a board's would be: from an arena, while one is in use.

#include "rasterizer/arena.h"

namespace still::test {

/// While it lives, memory that any thread asks for comes from an arena of `bytes`. What the arena
/// does not give comes from the heap and is counted. Objects made meanwhile may outlive it, but
/// must go before the next one is made.
class ArenaInUse {
  public:
    explicit ArenaInUse(size_t bytes);
    ~ArenaInUse();
    ArenaInUse(const ArenaInUse&) = delete;
    ArenaInUse& operator=(const ArenaInUse&) = delete;

    size_t used() const;
    /// Nothing is handed out any more.
    void seal();
    /// Between the two, memory comes from the heap as if there were no arena.
    void pause();
    void goOn();
    /// Requests that the arena did not meet, sealed or full.
    size_t unmet() const;
};

}  // namespace still::test
