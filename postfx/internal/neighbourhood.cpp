#include "postfx/internal/neighbourhood.h"

#include <algorithm>

#include "rasterizer/fixed.h"

namespace still::taa {
namespace {

/// 4·Y, 2·Co·2, 4·Cg: exact in integers.
struct Ycc {
    int64_t v[3];
};

Ycc toYcc(int64_t r, int64_t g, int64_t b) {
    return {{r + 2 * g + b, 2 * (r - b), 2 * g - r - b}};
}

/// floor(√n), bit by bit.
int64_t rootOf(int64_t n) {
    int64_t root = 0;
    for (int64_t bit = int64_t{1} << 30; bit != 0; bit >>= 1) {
        const int64_t trial = root + bit;
        root = trial * trial <= n ? trial : root;
    }
    return root;
}

}  // namespace

bool clipToWindow(const ResolveJob& job, int x, int y, int rgb[3]) noexcept {
    int64_t sum[3] = {}, squares[3] = {}, n = 0;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, job.height - 1); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, job.width - 1); ++i) {
            const ptrdiff_t at = j * job.stride + i;
            const Ycc c =
                toYcc(job.now.colour[0][at], job.now.colour[1][at], job.now.colour[2][at]);
            for (int k = 0; k < 3; ++k) {
                sum[k] += c.v[k];
                squares[k] += c.v[k] * c.v[k];
            }
            ++n;
        }
    }
    const Ycc old = toYcc(rgb[0], rgb[1], rgb[2]);
    Ycc kept;
    for (int k = 0; k < 3; ++k) {
        const int64_t deviation = rootOf(n * squares[k] - sum[k] * sum[k]);  // times n
        kept.v[k] = std::clamp(old.v[k], floorDiv(sum[k] - deviation, n),
                               -floorDiv(-sum[k] - deviation, n));
    }
    if (kept.v[0] == old.v[0] && kept.v[1] == old.v[1] && kept.v[2] == old.v[2]) {
        return false;
    }
    const int64_t red_blue = kept.v[0] - kept.v[2];  // 2·(r + b)
    const auto channel = [](int64_t four) {
        return int(std::clamp<int64_t>(roundShift(four, 2), 0, 65535));
    };
    rgb[0] = channel(red_blue + kept.v[1]);
    rgb[1] = channel(kept.v[0] + kept.v[2]);
    rgb[2] = channel(red_blue - kept.v[1]);
    return true;
}

}  // namespace still::taa
