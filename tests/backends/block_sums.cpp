// What a block of a kernel adds to its tally, with a thread of the host for each lane of a warp.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <barrier>
#include <memory>
#include <mutex>
#include <random>
#include <thread>
#include <vector>

namespace {

/// The lanes of a warp, who tell one another a number at a time.
struct Warp {
    std::barrier<> all{32};
    std::array<unsigned long long, 32> told{};
};
struct Place {
    unsigned int x;
};
thread_local Warp* warp = nullptr;
thread_local Place threadIdx{};
constexpr Place blockIdx{5};
std::mutex memory;

std::array<unsigned long long, 32> tell(unsigned long long value) {
    warp->told[threadIdx.x % 32] = value;
    warp->all.arrive_and_wait();
    const auto told = warp->told;
    warp->all.arrive_and_wait();
    return told;
}

template <class T>
T __shfl_xor_sync(unsigned int, T value, int step) {
    return static_cast<T>(tell(value)[threadIdx.x % 32 ^ static_cast<unsigned int>(step)]);
}
bool __any_sync(unsigned int, bool value) {
    const auto told = tell(value);
    return std::find(told.begin(), told.end(), 1u) != told.end();
}
template <class T>
void atomicAdd(T* to, T value) {
    const std::lock_guard lock(memory);
    *to += value;
}
template <class T>
void atomicMax(T* to, T value) {
    const std::lock_guard lock(memory);
    *to = std::max(*to, value);
}
template <class T>
void atomicOr(T* to, T value) {
    const std::lock_guard lock(memory);
    *to |= value;
}

}  // namespace

#include "backend_cuda/kernels/kernel_parts.cuh"

namespace cistula {
namespace {

void expect_equal(const Total& a, const Total& b, int kind) {
    EXPECT_EQ(a.low, b.low) << kind;
    EXPECT_EQ(a.high, b.high) << kind;
    EXPECT_EQ(a.most, b.most) << kind;
}

/// Adds up random records of a block: of four or eight warps, with losses of one kind, both or none, few or many.
template <int threads>
void check(int kind, std::mt19937_64& random) {
    const auto block = std::make_unique<BlockStorage<threads>>();
    const auto tally = std::make_unique<DeviceTally>();
    RayCounts rays;
    PixelTotals totals;
    uint32_t flags = 0;
    for (int i = 0; i < threads; ++i) {
        PixelRecord& record = block->records[i] = {};
        PixelWork& work = block->work[i] = {};
        const unsigned int most = kind == 3 ? 1u << 20 : 50;  // of rays: counts are summed in halves of words, or not
        work.rays = {1, unsigned(random() % most), unsigned(random() % most), unsigned(random() % most)};
        if (random() % 64 == 0) work.flags = flag_not_finite;
        flags |= work.flags;
        record.rays = work.rays.total();
        const auto loss = [&] { return random() % 3 == 0 ? int64_t(random() >> (2 + random() % 60)) : 0; };
        for (int c = 0; c < 3; ++c) {
            if (kind & 1) record.cut[c] = loss();
            if ((kind & 2) && (kind < 4 || i == 77)) record.pruned[c] = loss();
        }
        rays.add(work.rays);
        totals.add(record, record.rays);
    }
    std::vector<std::thread> lanes;
    std::array<Warp, threads / 32> warps;
    for (int i = 0; i < threads; ++i)
        if (const int own = i / 32; own == 0 || own % 4 == 3)
            lanes.emplace_back([&, i, own] {
                warp = &warps[size_t(own)];
                threadIdx.x = unsigned(i);
                if (own == 0) return add_block_to_tally(*tally, *block);
                add_losses_to_tally(*tally, block->records + (own - 3) * 32, 128);
            });
    for (std::thread& lane : lanes) lane.join();
    for (int c = 0; c < 3; ++c) {
        expect_equal(tally->losses[blockIdx.x][c], totals.pruned[c], kind);
        expect_equal(tally->losses[blockIdx.x][3 + c], totals.cut[c], kind);
    }
    EXPECT_EQ(tally->most_rays[blockIdx.x], totals.units.most) << kind;
    const auto& counted = tally->rays[blockIdx.x];
    EXPECT_EQ(std::vector(counted, counted + 4),
              (std::vector<unsigned long long>{rays.primary, rays.reflected, rays.transmitted, rays.shadow}));
    EXPECT_EQ(rays.total(), totals.units.low) << kind;
    EXPECT_EQ(tally->flags, flags) << kind;
}

TEST(BlockSums, AreThoseOfItsPixels) {
    std::mt19937_64 random(1);
    for (int kind = 0; kind < 8; ++kind)
        for (int round = 0; round < 5; ++round) {
            check<128>(kind, random);
            check<256>(kind, random);
        }
}

}  // namespace
}  // namespace cistula
