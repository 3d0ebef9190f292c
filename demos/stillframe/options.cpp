#include "demos/stillframe/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "engine/det_math.h"

namespace still::command {
namespace {

/// The whole of `text` as a decimal number without sign.
std::optional<int> wholeNumber(std::string_view text) {
    int value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || text.starts_with('-')) {
        return std::nullopt;
    }
    return value;
}

/// "a, b, c" of what `nameOf` makes of the elements.
template <class Range, class NameOf>
std::string listed(const Range& range, NameOf&& nameOf) {
    std::string list;
    for (const auto& element : range) {
        list += (list.empty() ? "" : ", ") + std::string(nameOf(element));
    }
    return list;
}

/// A value that does not fit is an error of the option's.
template <class T>
Outcome<T> ofOption(const char* option, Result<T> result) {
    return std::move(result).map_error([&](const Error& error) {
        return Failure{ExitCode::usage, option + (": " + error.message)};
    });
}

constexpr DumpPlane kDumpPlanes[] = {DumpPlane::color,  DumpPlane::depth, DumpPlane::normal,
                                     DumpPlane::motion, DumpPlane::id,    DumpPlane::confidence};

std::optional<DumpPlane> dumpPlane(std::string_view text) {
    for (DumpPlane plane : kDumpPlanes) {
        if (dumpName(plane) == text) {
            return plane;
        }
    }
    return std::nullopt;
}

}  // namespace

Outcome<Size> parseResolution(const std::string& text) {
    const size_t separator = text.find_first_of("x,");
    if (separator != std::string::npos) {
        const auto width = wholeNumber(std::string_view(text).substr(0, separator));
        const auto height = wholeNumber(std::string_view(text).substr(separator + 1));
        const auto fits = [](std::optional<int> n) { return n && *n >= 1 && *n <= kMaxTargetSize; };
        if (fits(width) && fits(height)) {
            return Size{*width, *height};
        }
    }
    return usageError("--resolution: " + text + ": expected WIDTHxHEIGHT, each from 1 to " +
                      std::to_string(kMaxTargetSize));
}

Outcome<AntiAliasingChoice> parseAntiAliasing(const std::string& text) {
    return ofOption("--anti-aliasing", still::parseAntiAliasing(text));
}

Outcome<TaaPolicy> parseTaaSettings(const std::string& text, TaaPolicy policy) {
    return ofOption("--taa", still::parseTaaSettings(text, policy));
}

double exposureFactor(double stops) {
    const double whole = std::floor(stops);
    return std::ldexp(det::pow(2, stops - whole), int(whole));
}

std::string dumpName(DumpPlane plane) {
    switch (plane) {
        case DumpPlane::color:
            return "color";
        case DumpPlane::depth:
            return "depth";
        case DumpPlane::normal:
            return "normal";
        case DumpPlane::motion:
            return "motion";
        case DumpPlane::id:
            return "id";
        case DumpPlane::confidence:
            return "confidence";
    }
    return {};
}

Outcome<std::vector<DumpPlane>> parseDump(const std::string& text) {
    std::vector<DumpPlane> planes;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        const auto plane = dumpPlane(std::string_view(text).substr(begin, end - begin));
        if (!plane) {
            return usageError("--dump: " + text.substr(begin, end - begin) +
                              ": expected planes out of color,depth,normal,motion,id,confidence");
        }
        planes.push_back(*plane);
        begin = end + 1;
    }
    return planes;
}

Outcome<SimdTarget> parseSimd(const std::string& text) {
    if (text.empty()) {
        return bestSimdTarget();
    }
    const auto targets = availableSimdTargets();
    for (SimdTarget target : targets) {
        if (name(target) == text) {
            return target;
        }
    }
    return usageError("--simd: " + text + ": this machine and build have " +
                      listed(targets, [](SimdTarget target) { return name(target); }));
}

}  // namespace still::command
