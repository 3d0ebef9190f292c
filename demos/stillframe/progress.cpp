#include "demos/stillframe/progress.h"

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <string>

namespace still::command {

ProgressBar::ProgressBar(int total, bool quiet)
    : total_(total), terminal_(!quiet && isatty(STDERR_FILENO) == 1) {
    show(0);
}

ProgressBar::~ProgressBar() {
    clear();
}

void ProgressBar::show(int done) const {
    constexpr int kWidth = 40;
    if (terminal_) {
        const std::string full(size_t(int64_t{kWidth} * done / total_), '#');
        std::fprintf(stderr, "\r[%-*s] %d/%d", kWidth, full.c_str(), done, total_);
        std::fflush(stderr);
    }
}

void ProgressBar::clear() const {
    if (terminal_) {
        std::fputs("\r\033[K", stderr);
        std::fflush(stderr);
    }
}

}  // namespace still::command
