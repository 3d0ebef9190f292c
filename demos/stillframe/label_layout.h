#pragma once
// Where the names of points go, so that none covers a point, another name or a line.

#include <span>
#include <vector>

namespace still::command {

/// Axis-aligned, y down.
struct Box {
    double x = 0, y = 0, width = 0, height = 0;
    bool overlaps(const Box& other) const;
    bool contains(const Box& other) const;
};

struct LabelledPoint {
    double x = 0, y = 0;
    double width = 0, height = 0;  ///< of the label
};

struct PlacedLabel {
    Box box;
    bool leader = false;                ///< far enough away to need a line to its point …
    double leader_x = 0, leader_y = 0;  ///< … which ends here
};

/// Labels inside `area`, close to their points, earlier points first, clear of `obstacles`. Where
/// there is no free place, which takes more labels than the area holds, the label lies right of its
/// point all the same.
std::vector<PlacedLabel> placeLabels(std::span<const LabelledPoint> points,
                                     std::span<const Box> obstacles, const Box& area);

}  // namespace still::command
