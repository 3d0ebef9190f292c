// sRGB → YCxCz ─► filtered by what the eye resolves ─► L*a*b* ─► HyAB distance ──┐
//              └► edges and points of the luminance ─► largest change of them ───┴► error
// All filters are Gaussians or their derivatives, or sums of two of them, and run row by row, then
// column by column. Outside the border pixels repeat.

#include "postfx/flip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

namespace still {
namespace {

constexpr int kRowGrain = 8;
constexpr double kPi = 3.14159265358979323846;

struct Colour {
    double x, y, z;
};

/// Linear sRGB to CIE XYZ, from the primaries of BT.709 and D65.
constexpr Colour xyzOf(Colour rgb) {
    return {(10135552 * rgb.x + 8788810 * rgb.y + 4435075 * rgb.z) / 24577794,
            (2613072 * rgb.x + 8788810 * rgb.y + 887015 * rgb.z) / 12288897,
            (1425312 * rgb.x + 8788810 * rgb.y + 70074185 * rgb.z) / 73733382};
}
constexpr Colour kWhite = xyzOf({1, 1, 1});

/// The inverse of xyzOf().
constexpr Colour rgbOf(Colour xyz) {
    return {3.241003275 * xyz.x - 1.537398934 * xyz.y - 0.498615861 * xyz.z,
            -0.969224334 * xyz.x + 1.875930071 * xyz.y + 0.041554224 * xyz.z,
            0.055639423 * xyz.x - 0.204011202 * xyz.y + 1.057148933 * xyz.z};
}

double decoded(uint8_t code) {
    const double v = code / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

/// YCxCz: opponent colours, linear in light.
Colour opponentOf(Colour rgb) {
    const Colour c = xyzOf(rgb);
    const double x = c.x / kWhite.x, y = c.y / kWhite.y, z = c.z / kWhite.z;
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Colour rgbOfOpponent(Colour c) {
    const double y = (c.x + 16) / 116;
    return rgbOf({(y + c.y / 500) * kWhite.x, y * kWhite.y, (y - c.z / 200) * kWhite.z});
}

/// L*a*b* with chroma reduced in the dark (Hunt effect).
Colour labOf(Colour rgb) {
    const auto curve = [](double t) {
        constexpr double kDelta = 6.0 / 29;
        return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0 / 29;
    };
    const Colour c = xyzOf(rgb);
    const double x = curve(c.x / kWhite.x), y = curve(c.y / kWhite.y), z = curve(c.z / kWhite.z);
    const double lightness = 116 * y - 16;
    return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

double hyab(Colour a, Colour b) {
    const double da = a.y - b.y, db = a.z - b.z;
    return std::abs(a.x - b.x) + std::sqrt(da * da + db * db);
}

/// The paper's exponents and limits.
constexpr double kColourPower = 0.7, kFeaturePower = 0.5, kKnee = 0.4, kKneeValue = 0.95;

/// HyAB^0.7 mapped to 0 … 1, the lower 40 % of its range to 0 … 0.95.
class ErrorScale {
  public:
    ErrorScale() : most_(std::pow(hyab(labOf({0, 1, 0}), labOf({0, 0, 1})), kColourPower)) {}
    double operator()(double distance) const {
        const double power = std::pow(distance, kColourPower), knee = kKnee * most_;
        return power < knee ? kKneeValue / knee * power
                            : kKneeValue + (power - knee) / (most_ - knee) * (1 - kKneeValue);
    }

  private:
    double most_;  ///< between the two most distant colours, green and blue
};

/// One-dimensional kernel of 2 · radius + 1 weights.
struct Kernel {
    std::vector<float> weights;
    int radius() const { return int(weights.size() / 2); }
};

template <class Function>
Kernel sampledKernel(int radius, Function&& value) {
    Kernel kernel;
    for (int i = -radius; i <= radius; ++i) {
        kernel.weights.push_back(float(value(double(i))));
    }
    return kernel;
}

/// Positive weights sum up to 1, and negative ones to −1.
void balance(Kernel& kernel) {
    double above = 0, below = 0;
    for (float w : kernel.weights) {
        (w > 0 ? above : below) += w;
    }
    for (float& w : kernel.weights) {
        w = float(w / (w > 0 ? above : -below));
    }
}

/// Contrast sensitivity as a sum of two-dimensional Gaussians, scale · exp(−π² r² / width), r in
/// degrees.
struct Sensitivity {
    struct Term {
        double amplitude, width;
    };
    std::array<Term, 2> terms;
};
constexpr Sensitivity kLuminance{{{{1, 0.0047}, {0, 1}}}};
constexpr Sensitivity kRedGreen{{{{1, 0.0053}, {0, 1}}}};
constexpr Sensitivity kBlueYellow{{{{34.1, 0.04}, {13.5, 0.025}}}};
constexpr double kWidest = 0.04;

using Plane = Image<float>;

/// Every filter is Σ across ⊗ down.
struct Separable {
    Kernel across, down;
};

std::vector<Separable> sensitivityFilter(const Sensitivity& sensitivity, double pixels_per_degree) {
    const int radius = int(std::ceil(3 * std::sqrt(kWidest / (2 * kPi * kPi)) * pixels_per_degree));
    std::vector<Separable> filter;
    double sum = 0;
    for (const Sensitivity::Term& term : sensitivity.terms) {
        if (term.amplitude == 0) {
            continue;
        }
        const double scale = std::sqrt(term.amplitude * std::sqrt(kPi / term.width));
        const Kernel kernel = sampledKernel(radius, [&](double i) {
            const double degrees = i / pixels_per_degree;
            return scale * std::exp(-kPi * kPi * degrees * degrees / term.width);
        });
        double total = 0;
        for (float w : kernel.weights) {
            total += w;
        }
        sum += total * total;
        filter.push_back({kernel, kernel});
    }
    for (Separable& part : filter) {
        for (float& w : part.across.weights) {
            w = float(w / sum);
        }
    }
    return filter;
}

/// Gaussian and its first two derivatives, for edges and points.
struct FeatureKernels {
    Kernel smooth, edge, point;
};
FeatureKernels featureKernels(double pixels_per_degree) {
    const double sigma = 0.5 * 0.082 * pixels_per_degree;
    const int radius = int(std::ceil(3 * sigma));
    const auto gauss = [&](double i) { return std::exp(-i * i / (2 * sigma * sigma)); };
    FeatureKernels kernels{
        sampledKernel(radius, gauss),
        sampledKernel(radius, [&](double i) { return -i * gauss(i); }),
        sampledKernel(radius, [&](double i) { return (i * i / (sigma * sigma) - 1) * gauss(i); })};
    balance(kernels.smooth);
    balance(kernels.edge);
    balance(kernels.point);
    return kernels;
}

/// A row with `radius` repeated pixels at each end.
void padRow(const float* row, int width, int radius, std::vector<float>& out) {
    out.resize(size_t(width + 2 * radius));
    std::fill_n(out.begin(), radius, row[0]);
    std::copy_n(row, width, out.begin() + radius);
    std::fill_n(out.begin() + radius + width, radius, row[width - 1]);
}

/// out = (in ∗ across) ∗ down, added to what `out` holds when `add`.
void convolve(const Plane& in, const Separable& filter, bool add, Plane& out, Workers& workers) {
    const int width = in.width(), height = in.height();
    Plane rows(width, height);
    workers.parallelFor(height, kRowGrain, [&](int begin, int end, int) {
        std::vector<float> padded;
        for (int y = begin; y < end; ++y) {
            padRow(in.view().row(y), width, filter.across.radius(), padded);
            float* row = rows.view().row(y);
            std::fill_n(row, width, 0.0f);
            for (size_t k = 0; k < filter.across.weights.size(); ++k) {
                const float weight = filter.across.weights[k];
                for (int x = 0; x < width; ++x) {
                    row[x] += weight * padded[size_t(x) + k];
                }
            }
        }
    });
    out.resize(width, height);
    workers.parallelFor(height, kRowGrain, [&](int begin, int end, int) {
        const int radius = filter.down.radius();
        for (int y = begin; y < end; ++y) {
            float* to = out.view().row(y);
            if (!add) {
                std::fill_n(to, width, 0.0f);
            }
            for (int k = -radius; k <= radius; ++k) {
                const float weight = filter.down.weights[size_t(k + radius)];
                const float* from = rows.view().row(std::clamp(y + k, 0, height - 1));
                for (int x = 0; x < width; ++x) {
                    to[x] += weight * from[x];
                }
            }
        }
    });
}

struct Opponent {
    Plane y, cx, cz;
};

Opponent opponentPlanes(ImageView<const Rgb8> image, Workers& workers) {
    std::array<double, 256> linear;
    for (int code = 0; code < 256; ++code) {
        linear[size_t(code)] = decoded(uint8_t(code));
    }
    Opponent planes{Plane(image.width, image.height), Plane(image.width, image.height),
                    Plane(image.width, image.height)};
    workers.parallelFor(image.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < image.width; ++x) {
                const Rgb8 c = image.at(x, y);
                const Colour o = opponentOf({linear[c.r], linear[c.g], linear[c.b]});
                planes.y.at(x, y) = float(o.x);
                planes.cx.at(x, y) = float(o.y);
                planes.cz.at(x, y) = float(o.z);
            }
        }
    });
    return planes;
}

Plane filtered(const Plane& in, const Sensitivity& sensitivity, double pixels_per_degree,
               Workers& workers) {
    Plane out;
    bool add = false;
    for (const Separable& part : sensitivityFilter(sensitivity, pixels_per_degree)) {
        convolve(in, part, add, out, workers);
        add = true;
    }
    return out;
}

/// What one picture brings to the comparison.
struct Appearance {
    Opponent seen;      ///< as the eye resolves it
    Plane edge, point;  ///< strength of features of the unfiltered luminance
};

/// √(horizontal² + vertical²), luminance in 0 … 1.
Plane featureStrength(const Plane& y, const Kernel& derivative, const Kernel& smooth,
                      Workers& workers) {
    Plane across, down;
    convolve(y, {derivative, smooth}, false, across, workers);
    convolve(y, {smooth, derivative}, false, down, workers);
    for (int row = 0; row < y.height(); ++row) {
        float* a = across.view().row(row);
        const float* d = down.view().row(row);
        for (int x = 0; x < y.width(); ++x) {
            a[x] = std::sqrt(a[x] * a[x] + d[x] * d[x]) / 116;
        }
    }
    return across;
}

Appearance appearanceOf(ImageView<const Rgb8> image, double pixels_per_degree, Workers& workers) {
    const Opponent planes = opponentPlanes(image, workers);
    const FeatureKernels kernels = featureKernels(pixels_per_degree);
    return {{filtered(planes.y, kLuminance, pixels_per_degree, workers),
             filtered(planes.cx, kRedGreen, pixels_per_degree, workers),
             filtered(planes.cz, kBlueYellow, pixels_per_degree, workers)},
            featureStrength(planes.y, kernels.edge, kernels.smooth, workers),
            featureStrength(planes.y, kernels.point, kernels.smooth, workers)};
}

Colour labAt(const Opponent& seen, int x, int y) {
    Colour rgb = rgbOfOpponent({seen.y.at(x, y), seen.cx.at(x, y), seen.cz.at(x, y)});
    for (double* channel : {&rgb.x, &rgb.y, &rgb.z}) {
        *channel = std::clamp(*channel, 0.0, 1.0);
    }
    return labOf(rgb);
}

double errorAt(const Appearance& a, const Appearance& b, const ErrorScale& scale, int x, int y) {
    const double colour = scale(hyab(labAt(a.seen, x, y), labAt(b.seen, x, y)));
    const double edge = std::abs(double(a.edge.at(x, y)) - double(b.edge.at(x, y)));
    const double point = std::abs(double(a.point.at(x, y)) - double(b.point.at(x, y)));
    const double feature = std::pow(std::max(edge, point) / std::sqrt(2.0), kFeaturePower);
    return std::pow(colour, 1 - feature);
}

}  // namespace

Image<float> flipMap(ImageView<const Rgb8> reference, ImageView<const Rgb8> test,
                     const FlipSettings& settings, Workers& workers) {
    assert(reference.width == test.width && reference.height == test.height && !test.empty());
    assert(settings.pixels_per_degree > 0);
    const Appearance a = appearanceOf(reference, settings.pixels_per_degree, workers);
    const Appearance b = appearanceOf(test, settings.pixels_per_degree, workers);
    const ErrorScale scale;
    Image<float> map(test.width, test.height);
    workers.parallelFor(test.height, kRowGrain, [&](int begin, int end, int) {
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < test.width; ++x) {
                map.at(x, y) = float(errorAt(a, b, scale, x, y));
            }
        }
    });
    return map;
}

double meanFlip(ImageView<const Rgb8> reference, ImageView<const Rgb8> test,
                const FlipSettings& settings, Workers& workers) {
    const Image<float> map = flipMap(reference, test, settings, workers);
    double sum = 0;
    for (int y = 0; y < map.height(); ++y) {
        for (int x = 0; x < map.width(); ++x) {
            sum += double(map.at(x, y));
        }
    }
    return sum / (double(map.width()) * double(map.height()));
}

}  // namespace still
