#include "tests/support/plane_compare.h"

#include <sstream>

namespace still::test {
namespace {

void print(std::ostream& out, uint32_t v) {
    out << v;
}
void print(std::ostream& out, Motion v) {
    out << "(" << v.x_fx8 << ", " << v.y_fx8 << ")";
}

template <class T>
std::string firstDifference(const std::string& plane, ImageView<const T> a, ImageView<const T> b) {
    if (a.width != b.width || a.height != b.height) {
        return plane + ": sizes differ";
    }
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            if (!(a.at(x, y) == b.at(x, y))) {
                std::ostringstream text;
                text << plane << ": tile (" << x / kTileSize << ", " << y / kTileSize
                     << "), pixel (" << x << ", " << y << "): ";
                print(text, a.at(x, y));
                text << " and ";
                print(text, b.at(x, y));
                return text.str();
            }
        }
    }
    return {};
}

template <class T>
void compare(std::string& found, const std::string& plane, const Image<T>& a, const Image<T>& b) {
    if (found.empty()) {
        found = firstDifference(plane, a.view(), b.view());
    }
}

}  // namespace

std::string firstDifference(const GBuffer& a, const GBuffer& b) {
    std::string found;
    compare(found, "depth", a.depth, b.depth);
    compare(found, "id", a.id, b.id);
    if (a.planes.normal && b.planes.normal) {
        compare(found, "normal", a.normal, b.normal);
    }
    if (a.planes.motion && b.planes.motion) {
        compare(found, "motion", a.motion, b.motion);
        compare(found, "depth_before", a.depth_before, b.depth_before);
    }
    if (a.planes.albedo && b.planes.albedo) {
        compare(found, "albedo_red", a.albedo_red, b.albedo_red);
        compare(found, "albedo_green", a.albedo_green, b.albedo_green);
        compare(found, "albedo_blue", a.albedo_blue, b.albedo_blue);
    }
    compare(found, "red", a.red, b.red);
    compare(found, "green", a.green, b.green);
    compare(found, "blue", a.blue, b.blue);
    return found;
}

}  // namespace still::test
