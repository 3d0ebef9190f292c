#include "demos/stillframe/peak_memory.h"

#include <sys/resource.h>

#include <fstream>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace still::command {

uint64_t peakMemoryBytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return uint64_t(usage.ru_maxrss) * 1024;
}

void resetPeakMemory() {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
    std::ofstream("/proc/self/clear_refs") << "5";  // see proc(5)
}

}  // namespace still::command
