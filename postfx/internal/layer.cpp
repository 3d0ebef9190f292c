#include "postfx/internal/layer.h"

namespace still::taa {

ptrdiff_t farthestInWindow(const Job& job, int x, int y) noexcept {
    const auto better = [&](ptrdiff_t a, ptrdiff_t b) {
        return logDepth16(job.now.depth[b]) < logDepth16(job.now.depth[a]) ? b : a;
    };
    const auto column = [&](int cx) {
        const ptrdiff_t centre = y * job.stride + cx;
        ptrdiff_t best = centre;
        best = y > 0 ? better(best, centre - job.stride) : best;
        return y + 1 < job.height ? better(best, centre + job.stride) : best;
    };
    ptrdiff_t best = column(x);
    best = x > 0 ? better(best, column(x - 1)) : best;
    return x + 1 < job.width ? better(best, column(x + 1)) : best;
}

bool lowContrast(const Job& job, int x, int y, int shift) noexcept {
    bool low_contrast = true;
    for (const uint16_t* plane : job.now.colour) {
        int low = 65535, high = 0;
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, job.height - 1); ++j) {
            for (int i = std::max(x - 1, 0); i <= std::min(x + 1, job.width - 1); ++i) {
                low = std::min<int>(low, plane[j * job.stride + i]);
                high = std::max<int>(high, plane[j * job.stride + i]);
            }
        }
        low_contrast &= high - low <= contrastBound(high, shift);
    }
    return low_contrast;
}

}  // namespace still::taa
