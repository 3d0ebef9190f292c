// `stillframe chart`, as a whole, and its parts.

#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>
#include <tuple>

#include "demos/stillframe/chart_run.h"
#include "demos/stillframe/label_layout.h"
#include "demos/stillframe/pareto.h"
#include "tests/cli/shell.h"
#include "tests/support/data_path.h"

namespace still::test {
namespace {

using command::Box;
using command::Offer;

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// Walks along the offers by price: on the front is what is nearer than all that is cheaper, and
/// its equals. Another way than the program's.
std::vector<size_t> walkedFront(const std::vector<Offer>& offers) {
    std::vector<size_t> order(offers.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return std::tuple(offers[a].price, offers[a].error, a) <
               std::tuple(offers[b].price, offers[b].error, b);
    });
    std::vector<size_t> front;
    for (size_t i : order) {
        const bool first = front.empty();
        const Offer last = first ? Offer{} : offers[front.back()];
        const bool equal = !first && offers[i].price == last.price && offers[i].error == last.error;
        if (first || equal || offers[i].error < last.error) {
            front.push_back(i);
        }
    }
    return front;
}

}  // namespace

TEST_CASE("pareto: the front is found whichever way one looks for it", "[cli]") {
    CHECK(command::paretoFront({}).empty());
    std::mt19937 random(1);
    for (int round = 0; round < 300; ++round) {
        std::vector<Offer> offers(random() % 12 + 1);
        for (Offer& offer : offers) {
            offer = {double(random() % 6), double(random() % 6) - 3};  // ties are common
        }
        REQUIRE(command::paretoFront(offers) == walkedFront(offers));
    }
}

TEST_CASE("pareto: prices within the tolerance count as equal", "[cli]") {
    const std::vector<Offer> offers{{10.0, 5}, {10.2, 5}, {10.1, 4}, {10.3, 4}, {20, 4}, {9, 6}};
    CHECK(command::paretoFront(offers, 0.03) == std::vector<size_t>{5, 2, 3});
    CHECK(command::paretoFront(offers) == std::vector<size_t>{5, 0, 2});
}

TEST_CASE("label layout: labels lie inside, beside the points and clear of each other", "[cli]") {
    const Box area{0, 0, 500, 320};
    std::mt19937 random(2);
    for (int round = 0; round < 20; ++round) {
        std::vector<command::LabelledPoint> points;
        for (int i = 0; i < 20; ++i) {  // a heap of points
            points.push_back({150.0 + random() % 60, 150.0 + random() % 60, 70, 14});
        }
        const Box obstacle{0, 130, 500, 2};
        const auto labels = command::placeLabels(points, std::span(&obstacle, 1), area);
        REQUIRE(labels.size() == points.size());
        for (size_t i = 0; i < labels.size(); ++i) {
            REQUIRE(area.contains(labels[i].box));
            REQUIRE_FALSE(labels[i].box.overlaps(obstacle));
            for (size_t k = 0; k < labels.size(); ++k) {
                REQUIRE_FALSE(labels[i].box.contains({points[k].x, points[k].y, 0, 0}));
                REQUIRE_FALSE((i != k && labels[i].box.overlaps(labels[k].box)));
            }
        }
    }
}

TEST_CASE("chart: a run writes pictures and numbers for every scene", "[cli]") {
    const TempFolder folder;
    const Ran ran = shell(folder.path(),
                          "stillframe chart builtin:triangle builtin:cubes --frames 8 "
                          "--resolution 64x36 --samples 16 --cache cache --output out --json");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    const auto out = folder.path() / "out";
    CHECK(ran.out == contentsOf(out / "chart.json"));
    for (const char* part :
         {"\"scene\": \"triangle\"", "\"scene\": \"cubes\"", "\"segment\": \"moving\"",
          "\"segment\": \"still\"", "\"threads\": 1,", "\"preset\": \"raw\"",
          "\"preset\": \"fxaa\"", "\"preset\": \"ssaa:16\"", "\"preset\": \"still\"",
          "\"psnr_front\": true"}) {
        INFO(part);
        CHECK(has(ran.out, part));
    }
    CHECK_FALSE(has(ran.out, "nan"));
    CHECK_FALSE(has(ran.out, "inf"));
    CHECK(contentsOf(out / "cubes-1-thread.png").starts_with("\x89PNG"));
    const std::string svg = contentsOf(out / "triangle-1-thread.svg");
    CHECK(has(svg, "<svg"));
    CHECK(has(svg, "</svg>"));
}

TEST_CASE("chart: what cannot be meant or read is refused in one line", "[cli]") {
    const TempFolder folder;
    const auto refused = [&](const std::string& arguments, int code) {
        const Ran ran = shell(folder.path(), "stillframe chart " + arguments);
        INFO(arguments << "\n" << ran.err);
        CHECK(ran.code == code);
        CHECK(isOneErrorLine(ran.err));
        CHECK(ran.out.empty());
        CHECK(filesIn(folder.path()).empty());
    };
    refused("", 2);
    refused("--output out", 2);
    refused("builtin:triangle", 2);
    refused("builtin:nowhere --output out", 2);
    refused("builtin:triangle --output out --frames 3", 2);
    refused("missing.obj --output out", 3);
}

}  // namespace still::test
