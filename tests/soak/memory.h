#pragma once
// What the process holds: counted by operator new of this program, and as the system sees it.

#include <cstdint>

namespace still::soak {

// Both are 0 in builds with a sanitizer.

/// Bytes handed out by operator new and not given back. Large planes are mapped, not counted; the
/// scripts' pictures are too small for that.
int64_t liveBytes();

/// Resident set; 0 where the system does not tell.
int64_t residentBytes();

}  // namespace still::soak
