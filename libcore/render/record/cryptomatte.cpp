#include "render/record/film_channel.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <memory>

namespace cistula {
namespace {

constexpr int ranks = 6;  // of a pixel; two in each layer of four channels

/// One kind of matte: its name, and the name of each object that counts, by 1 + object; empty: does not count.
struct Mattes {
    std::string name;
    std::vector<std::string> names;
    std::vector<float> ids;
};

Mattes mattes_of(std::string name, std::vector<std::string> names) {
    Mattes mattes{std::move(name), std::move(names), {}};
    for (const std::string& object : mattes.names) mattes.ids.push_back(object.empty() ? 0.0f : cryptomatte_id(object));
    return mattes;
}

/// The kinds that are asked for.
std::vector<Mattes> kinds(const Film& film, const OutputChannels& channels) {
    std::vector<Mattes> mattes;
    if (film.layers.plan.objects < 0) return mattes;
    const LayerNames& names = *film.layers.names;
    const size_t solids = names.objects.size();
    const size_t all = 1 + solids + names.visible_lights.size();
    if (channels.object_mattes) {
        std::vector<std::string> of(all);
        std::copy(names.objects.begin(), names.objects.end(), of.begin() + 1);
        mattes.push_back(mattes_of("CryptoObject", std::move(of)));
    }
    if (channels.material_mattes) {
        std::vector<std::string> of(all);
        for (size_t i = 0; i < solids; ++i) of[i + 1] = names.materials[names.object_materials[i]];
        mattes.push_back(mattes_of("CryptoMaterial", std::move(of)));
    }
    if (channels.light_mattes) {
        std::vector<std::string> of(all);
        std::copy(names.visible_lights.begin(), names.visible_lights.end(), of.begin() + 1 + ptrdiff_t(solids));
        mattes.push_back(mattes_of("CryptoLight", std::move(of)));
    }
    return mattes;
}

/// An id and the number of samples that met it.
struct Rank {
    float id = 0;
    uint32_t samples = 0;
};
using Ranks = std::array<Rank, ranks>;

/// The ranks of blocks of pixels, which all channels of a kind share. Each thread keeps those of its last block.
class RankedBlocks {
  public:
    RankedBlocks(const Film& film, Mattes mattes) : film_(film), mattes_(std::move(mattes)) {}

    const std::vector<Ranks>& of(size_t first, size_t last) {
        Block& block = blocks_.local();
        if (first == block.first && last == block.last) return block.ranks;
        block.ranks.clear();
        for (size_t pixel = first; pixel < last; ++pixel) block.ranks.push_back(ranks_of(pixel, block.met));
        block.first = first;
        block.last = last;
        return block.ranks;
    }

  private:
    struct Block {
        size_t first = 0;
        size_t last = 0;
        std::vector<Ranks> ranks;
        std::vector<Rank> met;  // by one pixel; kept for its memory
    };

    Ranks ranks_of(size_t pixel, std::vector<Rank>& met) const {
        const LayerPlan& plan = film_.layers.plan;
        const int64_t* table = film_.layers.of(pixel) + plan.objects;
        met.clear();
        for (int i = 0; i < plan.object_entries && table[i] != 0; ++i) {
            const auto object = static_cast<size_t>(static_cast<uint64_t>(table[i]) >> object_shift);
            const auto samples = static_cast<uint32_t>(table[i]);
            if (samples == 0 || mattes_.names[object].empty()) continue;
            const float id = mattes_.ids[object];
            const auto known = std::find_if(met.begin(), met.end(), [id](const Rank& rank) { return rank.id == id; });
            if (known == met.end())
                met.push_back({id, samples});
            else
                known->samples += samples;
        }
        std::sort(met.begin(), met.end(), [](const Rank& a, const Rank& b) {
            return a.samples != b.samples ? a.samples > b.samples : a.id < b.id;
        });
        Ranks best;
        std::copy_n(met.begin(), std::min(met.size(), best.size()), best.begin());
        return best;
    }

    const Film& film_;
    const Mattes mattes_;
    tbb::enumerable_thread_specific<Block> blocks_;
};

/// The key under which a kind's attributes stand: seven hexadecimal digits.
std::string key_of(const std::string& name) {
    return fmt::format("{:08x}", murmur3(name)).substr(0, 7);
}

std::string manifest_of(const Mattes& mattes) {
    nlohmann::json manifest = nlohmann::json::object();
    for (size_t i = 0; i < mattes.names.size(); ++i)
        if (!mattes.names[i].empty())
            manifest[mattes.names[i]] = fmt::format("{:08x}", bits_as<uint32_t>(mattes.ids[i]));
    return manifest.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::vector<LayeredPicture::Channel> cryptomatte_channels(const Film& film, const OutputChannels& channels) {
    std::vector<LayeredPicture::Channel> to;
    for (Mattes& mattes : kinds(film, channels)) {
        const std::string name = mattes.name;
        const auto blocks = std::make_shared<RankedBlocks>(film, std::move(mattes));
        for (int rank = 0; rank < ranks; ++rank)
            for (const bool coverage : {false, true}) {
                const char channel = "rgba"[rank % 2 * 2 + coverage];
                to.push_back({fmt::format("{}{:02}.{}", name, rank / 2, channel),
                              false,
                              {},
                              [blocks, rank, coverage, &film](size_t first, size_t last, float* values) {
                                  for (const Ranks& of : blocks->of(first, last)) {
                                      const Rank& own = of[static_cast<size_t>(rank)];
                                      *values++ =
                                          coverage ? static_cast<float>(double(own.samples) / film.samples) : own.id;
                                  }
                              }});
            }
    }
    return to;
}

std::vector<std::pair<std::string, std::string>> cryptomatte_attributes(const Film& film,
                                                                        const OutputChannels& channels) {
    std::vector<std::pair<std::string, std::string>> attributes;
    for (const Mattes& mattes : kinds(film, channels)) {
        const std::string place = "cryptomatte/" + key_of(mattes.name) + "/";
        attributes.emplace_back(place + "name", mattes.name);
        attributes.emplace_back(place + "hash", "MurmurHash3_32");
        attributes.emplace_back(place + "conversion", "uint32_to_float32");
        attributes.emplace_back(place + "manifest", manifest_of(mattes));
    }
    return attributes;
}

namespace {

constexpr uint32_t first_factor = 0xcc9e2d51u;
constexpr uint32_t second_factor = 0x1b873593u;

uint32_t mixed(uint32_t word) {
    return std::rotl(word * first_factor, 15) * second_factor;
}

}  // namespace

uint32_t murmur3(std::string_view text) {
    const auto byte = [&](size_t i) { return uint32_t{static_cast<unsigned char>(text[i])}; };
    uint32_t hash = 0;
    const size_t whole = text.size() / 4 * 4;
    for (size_t i = 0; i < whole; i += 4) {
        hash ^= mixed(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
        hash = std::rotl(hash, 13) * 5 + 0xe6546b64u;
    }
    uint32_t rest = 0;
    for (size_t i = text.size(); i-- > whole;) rest = rest << 8 | byte(i);
    hash ^= mixed(rest);
    hash ^= static_cast<uint32_t>(text.size());
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

float cryptomatte_id(std::string_view name) {
    uint32_t bits = murmur3(name);
    const uint32_t exponent = bits >> 23 & 255u;
    if (exponent == 0 || exponent == 255) bits ^= 1u << 23;
    return std::bit_cast<float>(bits);
}

}  // namespace cistula
