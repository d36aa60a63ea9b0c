// SPDX-License-Identifier: MIT
//
// regions_box2d.cc - regions in Box2D: b2DynamicTree::Query().
#include "peers.h"

#include <box2d/box2d.h>

namespace {

// Writes down the bodies of a region.
struct Pairs {
    const b2DynamicTree *tree;
    uint64_t query, *out;
    size_t count;
    bool QueryCallback(int32 proxy) {
        out[count++] = query << 32 | reinterpret_cast<uintptr_t>(tree->GetUserData(proxy));
        return true;
    }
};

// The tree makes boxes fatter by b2_aabbExtension, which is taken off before.
void *create(const workload *workload, const narc_box *boxes) {
    auto *tree = new b2DynamicTree;
    const b2Vec2 fat(b2_aabbExtension, b2_aabbExtension);
    for (uintptr_t k = 0; k < workload->body_count; k++) {
        b2AABB box;
        box.lowerBound = b2Vec2(boxes[k].min_x, boxes[k].min_y) + fat;
        box.upperBound = b2Vec2(boxes[k].max_x, boxes[k].max_y) - fat;
        tree->CreateProxy(box, reinterpret_cast<void *>(k));
    }
    return tree;
}

size_t find(void *tree, const narc_box *regions, size_t count, uint64_t *out_pairs) {
    Pairs pairs = {static_cast<const b2DynamicTree *>(tree), 0, out_pairs, 0};
    for (size_t k = 0; k < count; k++) {
        b2AABB box;
        box.lowerBound.Set(regions[k].min_x, regions[k].min_y);
        box.upperBound.Set(regions[k].max_x, regions[k].max_y);
        pairs.query = k;
        pairs.tree->Query(&pairs, box);
    }
    return pairs.count;
}

} // namespace

const region_peer box2d_regions = {"Box2D", create, find};
