#pragma once
// How trees of triangles and of instances lie in memory: the same for all instruction sets.

#include <cstdint>
#include <vector>

#include "rasterizer/draw_list.h"

namespace still::internal {

/// Children of a node, triangles of a leaf: tested at once.
constexpr int kTreeWidth = 8;

/// BvhNode::child: nothing, or a node, or (with kLeafBit) a leaf.
constexpr uint32_t kLeafBit = 0x80000000u;
constexpr uint32_t kNoChild = 0xFFFFFFFFu;

/// Boxes of up to eight children. They are a little larger than what they hold (see kBoxMargin), so
/// that rounding never loses a triangle; those of empty children are turned inside out.
struct alignas(32) BvhNode {
    float bounds[2][3][kTreeWidth];  ///< low, high; x, y, z
    uint32_t child[kTreeWidth];
};

/// Boxes are widened by this part of the largest coordinate in the tree. What the intersection test
/// errs by is 2^-24 of a coordinate for each of a handful of operations.
constexpr float kBoxMargin = 1.0f / (1 << 21);

/// Of a triangle's number in a block: its material has holes.
constexpr uint32_t kHolesBit = 0x80000000u;
/// What stands in a block behind its last triangle.
constexpr uint32_t kNoTriangle = 0xFFFFFFFFu;

/// A leaf of a mesh's tree. Empty places hold triangles without area, which nothing hits.
struct alignas(32) TriangleBlock {
    float corner[3][3][kTreeWidth];  ///< corner; x, y, z
    uint32_t triangle[kTreeWidth];   ///< in the mesh, and kHolesBit
};

struct Box {
    float low[3] = {3e38f, 3e38f, 3e38f};
    float high[3] = {-3e38f, -3e38f, -3e38f};

    void add(const float p[3]);
    void add(const Box& other);
    float halfArea() const;
};

/// Leaves are triangle blocks.
struct MeshTree {
    std::vector<BvhNode> nodes;  ///< [0] is the root; empty: nothing to hit
    std::vector<TriangleBlock> blocks;
    Box bounds;
};

/// An instance as rays see it.
struct InstanceTree {
    const MeshTree* tree = nullptr;
    const Mesh* mesh = nullptr;
    bool identity = true;
    float to_object[12];  ///< world → object, row-major 3×4
    uint16_t first_surface = 1;
};

/// Leaves are instances.
struct SceneTree {
    std::vector<BvhNode> nodes;
    std::vector<InstanceTree> instances;
    const DrawList* list = nullptr;
};

/// Nodes over boxes, at most `leaf_size` in each leaf; `leaf(indices, count)` is called for each
/// one, in the order of their places in the tree, and says the number to be stored.
class TreeBuilder {
  public:
    /// `margin` is added to all sides of every box.
    TreeBuilder(const std::vector<Box>& boxes, float margin, int leaf_size);

    /// Builds the nodes and hands out the leaves: leaf i holds order()[leafBegin(i) …].
    void build(std::vector<BvhNode>& nodes);

    struct Leaf {
        uint32_t begin, count;
    };
    const std::vector<Leaf>& leaves() const { return leaves_; }
    const std::vector<uint32_t>& order() const { return order_; }

  private:
    struct Range {
        uint32_t begin, end;
        Box box;
    };
    /// Between bins `bin` and `bin` + 1 of an axis.
    struct Cut {
        float cost = 0.0f;
        int axis = -1, bin = 0;
        float low = 0.0f, scale = 0.0f;  ///< of the bins
    };
    int binOf(uint32_t box, const Cut& cut) const;
    void tryAxis(const Range& range, const Box& centres, int axis, Cut& best) const;
    Range rangeOf(uint32_t begin, uint32_t end) const;
    uint32_t splitAt(const Range& range, bool halve);
    uint32_t addNode(const Range& range, int depth, std::vector<BvhNode>& nodes);

    const std::vector<Box>& boxes_;
    float margin_;
    uint32_t leaf_size_;
    std::vector<float> centres_;  ///< three for each box, doubled
    std::vector<uint32_t> order_;
    std::vector<Leaf> leaves_;
};

/// `holes`: of each part of the mesh, whether its material has any.
void buildMeshTree(const Mesh& mesh, const std::vector<uint8_t>& holes, MeshTree& out);

/// The tree of instances; those of meshes are in `meshes`.
void buildSceneTree(const DrawList& list, const std::vector<MeshTree>& meshes, SceneTree& out);

}  // namespace still::internal
