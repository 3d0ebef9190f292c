// Trees by the surface area heuristic over 16 bins (Wald 2007), made eight wide at once: of the
// ranges of a node the one with the largest box is cut until there are eight. All in float with a
// written order and stable partitions: the same tree everywhere.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "rasterizer/draw_list_check.h"
#include "rasterizer/internal/bvh_node.h"
#include "rasterizer/internal/matrix.h"

namespace still::internal {

namespace {

constexpr int kBins = 16;
/// From this depth on the range with the most boxes is halved. Each child then has at most a
/// quarter of its parent's: no tree is deeper than 16 + 16 nodes, and two of them, with seven
/// children waiting in each node, fit into kTraceStack.
constexpr int kHalvingDepth = 16;
/// More than any cut costs.
constexpr float kNoCost = 1e38f;
/// Of boxes that hold nothing: turned inside out.
constexpr float kEmptyLow = 1e30f;

}  // namespace

void Box::add(const float p[3]) {
    for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
    }
}

void Box::add(const Box& other) {
    for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], other.low[k]);
        high[k] = std::max(high[k], other.high[k]);
    }
}

float Box::halfArea() const {
    if (low[0] > high[0]) {
        return 0.0f;
    }
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return (x * y + y * z) + z * x;
}

TreeBuilder::TreeBuilder(const std::vector<Box>& boxes, float margin, int leaf_size)
    : boxes_(boxes), margin_(margin), leaf_size_(uint32_t(leaf_size)) {
    centres_.resize(boxes.size() * 3);
    for (size_t i = 0; i < boxes.size(); ++i) {
        for (size_t k = 0; k < 3; ++k) {
            centres_[i * 3 + k] = boxes[i].low[k] + boxes[i].high[k];
        }
    }
    order_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), 0u);
}

TreeBuilder::Range TreeBuilder::rangeOf(uint32_t begin, uint32_t end) const {
    Range range{begin, end, {}};
    for (uint32_t i = begin; i < end; ++i) {
        range.box.add(boxes_[order_[i]]);
    }
    return range;
}

int TreeBuilder::binOf(uint32_t box, const Cut& cut) const {
    const float at = (centres_[size_t(box) * 3 + size_t(cut.axis)] - cut.low) * cut.scale;
    return std::min(int(at), kBins - 1);
}

/// The cheapest cut across `axis`, if it is cheaper than `best`.
void TreeBuilder::tryAxis(const Range& range, const Box& centres, int axis, Cut& best) const {
    const float extent = centres.high[axis] - centres.low[axis];
    Cut cut{.axis = axis, .low = centres.low[axis], .scale = float(kBins) / extent};
    if (!(extent > 0.0f) || !(cut.scale < 1e30f)) {
        return;
    }
    Box bins[kBins];
    uint32_t counts[kBins] = {};
    for (uint32_t i = range.begin; i < range.end; ++i) {
        const int bin = binOf(order_[i], cut);
        bins[bin].add(boxes_[order_[i]]);
        ++counts[bin];
    }
    float right_cost[kBins];
    Box right;
    uint32_t count = 0;
    for (int bin = kBins - 1; bin > 0; --bin) {
        right.add(bins[bin]);
        count += counts[bin];
        right_cost[bin] = count == 0 ? kNoCost : right.halfArea() * float(int32_t(count));
    }
    Box left;
    count = 0;
    for (int bin = 0; bin + 1 < kBins; ++bin) {
        left.add(bins[bin]);
        count += counts[bin];
        cut.bin = bin;
        cut.cost = left.halfArea() * float(int32_t(count)) + right_cost[bin + 1];
        if (count > 0 && cut.cost < best.cost) {
            best = cut;
        }
    }
}

/// Orders the range's boxes and says where its second part begins.
uint32_t TreeBuilder::splitAt(const Range& range, bool halve) {
    Cut best{.cost = kNoCost};
    if (!halve) {
        Box centres;
        for (uint32_t i = range.begin; i < range.end; ++i) {
            centres.add(&centres_[size_t(order_[i]) * 3]);
        }
        for (int axis = 0; axis < 3; ++axis) {
            tryAxis(range, centres, axis, best);
        }
    }
    if (best.axis < 0) {
        return range.begin + (range.end - range.begin) / 2;
    }
    const auto second =
        std::stable_partition(order_.begin() + range.begin, order_.begin() + range.end,
                              [&](uint32_t box) { return binOf(box, best) <= best.bin; });
    return uint32_t(second - order_.begin());
}

uint32_t TreeBuilder::addNode(const Range& range, int depth, std::vector<BvhNode>& nodes) {
    const uint32_t index = uint32_t(nodes.size());
    nodes.emplace_back();
    std::vector<Range> ranges{range};
    while (ranges.size() < size_t(kTreeWidth)) {
        const bool halve = depth >= kHalvingDepth;
        size_t largest = ranges.size();
        float size = -1.0f;
        for (size_t i = 0; i < ranges.size(); ++i) {
            const uint32_t count = ranges[i].end - ranges[i].begin;
            const float s = halve ? float(int32_t(count)) : ranges[i].box.halfArea();
            if (count > leaf_size_ && s > size) {
                size = s;
                largest = i;
            }
        }
        if (largest == ranges.size()) {
            break;
        }
        const Range cut = ranges[largest];
        const uint32_t middle = splitAt(cut, halve);
        ranges[largest] = rangeOf(cut.begin, middle);
        ranges.insert(ranges.begin() + ptrdiff_t(largest) + 1, rangeOf(middle, cut.end));
    }
    for (size_t i = 0; i < size_t(kTreeWidth); ++i) {
        uint32_t child = kNoChild;
        Box box;
        if (i < ranges.size()) {
            box = ranges[i].box;
            for (int k = 0; k < 3; ++k) {
                box.low[k] = box.low[k] - margin_;
                box.high[k] = box.high[k] + margin_;
            }
            if (ranges[i].end - ranges[i].begin <= leaf_size_) {
                child = kLeafBit | uint32_t(leaves_.size());
                leaves_.push_back({ranges[i].begin, ranges[i].end - ranges[i].begin});
            } else {
                child = addNode(ranges[i], depth + 1, nodes);
            }
        } else {
            std::fill_n(box.low, 3, kEmptyLow);
            std::fill_n(box.high, 3, -kEmptyLow);
        }
        BvhNode& node = nodes[index];
        node.child[i] = child;
        for (int k = 0; k < 3; ++k) {
            node.bounds[0][k][i] = box.low[k];
            node.bounds[1][k][i] = box.high[k];
        }
    }
    return index;
}

void TreeBuilder::build(std::vector<BvhNode>& nodes) {
    nodes.clear();
    leaves_.clear();
    if (!boxes_.empty()) {
        addNode(rangeOf(0, uint32_t(boxes_.size())), 0, nodes);
    }
}

namespace {

float largestCoordinate(const Box& box) {
    float largest = 0.0f;
    for (int k = 0; k < 3; ++k) {
        largest = std::max({largest, std::fabs(box.low[k]), std::fabs(box.high[k])});
    }
    return largest;
}

}  // namespace

void buildMeshTree(const Mesh& mesh, const std::vector<uint8_t>& holes, MeshTree& out) {
    const uint32_t count = mesh.triangleCount();
    const float* position[3] = {mesh.x.data(), mesh.y.data(), mesh.z.data()};
    std::vector<Box> boxes(count);
    out.bounds = {};
    for (uint32_t t = 0; t < count; ++t) {
        for (uint32_t c = 0; c < 3; ++c) {
            const uint32_t v = mesh.indices[size_t(t) * 3 + c];
            const float p[3] = {position[0][v], position[1][v], position[2][v]};
            boxes[t].add(p);
        }
        out.bounds.add(boxes[t]);
    }
    TreeBuilder builder(boxes, largestCoordinate(out.bounds) * kBoxMargin, kTreeWidth);
    builder.build(out.nodes);
    std::vector<uint8_t> with_holes(count, 0);
    for (size_t p = 0; p < mesh.parts.size(); ++p) {
        const MeshPart& part = mesh.parts[p];
        std::fill_n(with_holes.begin() + part.first_triangle, part.triangle_count, holes[p]);
    }
    out.blocks.assign(builder.leaves().size(), {});
    for (size_t l = 0; l < builder.leaves().size(); ++l) {
        TriangleBlock& block = out.blocks[l];
        const TreeBuilder::Leaf& leaf = builder.leaves()[l];
        std::fill_n(block.triangle, kTreeWidth, kNoTriangle);
        for (uint32_t i = 0; i < leaf.count; ++i) {
            const uint32_t t = builder.order()[leaf.begin + i];
            block.triangle[i] = t | (with_holes[t] != 0 ? kHolesBit : 0u);
            for (uint32_t c = 0; c < 3; ++c) {
                const uint32_t v = mesh.indices[size_t(t) * 3 + c];
                for (int k = 0; k < 3; ++k) {
                    block.corner[c][k][i] = position[k][v];
                }
            }
        }
    }
}

namespace {

/// World box of an instance: of the transformed corners of its mesh's box, a little larger than
/// rounding can make it.
Box worldBox(const Box& box, const Affine& m) {
    Box world;
    for (int corner = 0; corner < 8; ++corner) {
        const float p[3] = {(corner & 1) != 0 ? box.high[0] : box.low[0],
                            (corner & 2) != 0 ? box.high[1] : box.low[1],
                            (corner & 4) != 0 ? box.high[2] : box.low[2]};
        float q[3];
        for (size_t r = 0; r < 3; ++r) {
            q[r] = (m[r * 4] * p[0] + m[r * 4 + 1] * p[1]) + (m[r * 4 + 2] * p[2] + m[r * 4 + 3]);
        }
        world.add(q);
    }
    return world;
}

/// Where rays can be followed; false for NaN.
bool isSomewhere(const Box& box, const Affine& to_object) {
    const auto small = [](float value) { return within(value, kMaxPosition); };
    return std::all_of(box.low, box.low + 3, small) && std::all_of(box.high, box.high + 3, small) &&
           std::all_of(to_object.begin(), to_object.end(), small);
}

}  // namespace

void buildSceneTree(const DrawList& list, const std::vector<MeshTree>& meshes, SceneTree& out) {
    out.list = &list;
    out.instances.resize(list.instances.size());
    std::vector<Box> boxes;
    std::vector<uint32_t> numbers;
    Box all;
    for (uint32_t i = 0; i < list.instances.size(); ++i) {
        const Instance& instance = list.instances[i];
        InstanceTree& tree = out.instances[i];
        tree.tree = &meshes[instance.mesh];
        tree.mesh = &list.meshes[instance.mesh];
        tree.identity = instance.identity;
        tree.first_surface = instance.first_surface;
        const Matrix to_object = inverse(fromAffine(instance.transform));
        Affine back;
        for (size_t k = 0; k < back.size(); ++k) {
            back[k] = tree.to_object[k] = float(to_object.m[k / 4][k % 4]);
        }
        const Box box = worldBox(tree.tree->bounds, instance.transform);
        // Nothing hits what is flattened to nothing.
        if (!tree.tree->nodes.empty() && to_object.m[3][3] != 0.0 && isSomewhere(box, back)) {
            boxes.push_back(box);
            numbers.push_back(i);
            all.add(boxes.back());
        }
    }
    TreeBuilder builder(boxes, largestCoordinate(all) * (4.0f * kBoxMargin), 1);
    builder.build(out.nodes);
    for (BvhNode& node : out.nodes) {
        for (uint32_t& child : node.child) {
            if (child != kNoChild && (child & kLeafBit) != 0) {
                const TreeBuilder::Leaf& leaf = builder.leaves()[child & ~kLeafBit];
                child = kLeafBit | numbers[builder.order()[leaf.begin]];
            }
        }
    }
}

}  // namespace still::internal
