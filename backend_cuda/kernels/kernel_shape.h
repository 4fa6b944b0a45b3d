// Block sizes of the kernels, one row per effect mask, as measured on an H200 (docs/modules/backend_cuda.md).
#pragma once

#include "cistula/model/effects.h"

namespace cistula {

inline constexpr int warp_threads = 32;

/// The intersector and the form of scene and media that a kernel uses. Never changes the image.
enum class DevicePath {
    plain_loop,  // a loop over a ConstantScene: few primitives, closed solids all convex and apart
    ball_loop,   // a loop over a BallScene: the same with balls, which may touch
    tree,        // tree traversal, for any scene
};

/// The blocks of a mask's kernel. Warps that start together share fetched instructions, so large blocks pay off where
/// the code far exceeds the instruction caches. The number of resident blocks per multiprocessor limits the registers
/// of a thread.
struct KernelShape {
    int warps;
    int loop_blocks[2];  // blocks a multiprocessor, loops: in float, in double
    int tree_blocks[2];
    bool together = true;  // whether samples start together: not where their trees differ much in size

    CISTULA_HD constexpr int threads() const { return warps * warp_threads; }
    CISTULA_HD constexpr int blocks(DevicePath path, bool in_float) const {
        return (path == DevicePath::tree ? tree_blocks : loop_blocks)[in_float ? 0 : 1];
    }
};

inline constexpr KernelShape kernel_shapes[] = {
    {4, {8, 5}, {6, 4}},         // opaque bodies
    {4, {7, 4}, {6, 4}},         // mirrors
    {4, {6, 4}, {6, 4}},         // clear bodies
    {4, {6, 4}, {6, 4}},         // colors and visible lights
    {8, {3, 2}, {3, 2}},         // flat bodies
    {4, {4, 4}, {6, 4}, false},  // balls, flat bodies, skies
    {8, {3, 2}, {3, 2}},         // everything
    {8, {3, 2}, {3, 2}},         // everything and a budget
    {8, {3, 2}, {3, 2}},         // everything and layers
};
static_assert(sizeof kernel_shapes / sizeof kernel_shapes[0] == compiled_mask_count, "a row for each mask");

inline constexpr int most_warps = 8;  // of a block

/// The block size of the kernel for adaptive sampling.
inline constexpr KernelShape adaptive_shape = {4, {6, 4}, {6, 4}};

}  // namespace cistula
