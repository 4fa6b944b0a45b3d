// Reads textures through the module for OpenImageIO: conversion of samples to linear colors.
#include <exception>
#include <new>
#include <utility>
#include <variant>

#include "scene/base/file_bytes.h"
#include "scene/image/picture_oiio.h"
#include "scene/image/picture_oiio_load.h"
#include "scene/image/srgb_codes.h"

namespace cistula {
namespace {

/// The state that the module's callbacks fill.
struct Exchange {
    uint32_t width = 0, height = 0, channels = 0;
    std::variant<std::vector<uint8_t>, std::vector<uint16_t>, std::vector<float>> samples;
    std::string reason;
    bool out_of_memory = false;

    Error error(const std::string& path) const {
        return file_error(path, "read", out_of_memory ? "not enough memory for a picture of its size" : reason);
    }
};

/// Runs work(exchange); an exception is recorded in the exchange.
template <class Work>
auto kept(void* self, Work work) noexcept -> decltype(work(std::declval<Exchange&>())) {
    Exchange& exchange = *static_cast<Exchange*>(self);
    try {
        return work(exchange);
    } catch (const std::exception&) {  // only memory allocation can fail
        exchange.out_of_memory = true;
        return {};
    }
}

void* room(void* self, uint32_t width, uint32_t height, uint32_t channels, OiioSamples type) noexcept {
    return kept(self, [&](Exchange& exchange) -> void* {
        exchange.width = width;
        exchange.height = height;
        exchange.channels = channels;
        const size_t count = static_cast<size_t>(width) * height * channels;
        switch (type) {
            case OiioSamples::uint8:
                return exchange.samples.emplace<std::vector<uint8_t>>(count).data();
            case OiioSamples::uint16:
                return exchange.samples.emplace<std::vector<uint16_t>>(count).data();
            case OiioSamples::float32:
                break;
        }
        return exchange.samples.emplace<std::vector<float>>(count).data();
    });
}

void take_reason(void* self, const char* reason) noexcept {
    kept(self, [&](Exchange& exchange) {
        exchange.reason = reason;
        return true;
    });
}

OiioHost host_of(Exchange& exchange) {
    return {&exchange, room, take_reason};
}

float linear(uint8_t code) {
    return linear_from_srgb8(code);
}
float linear(uint16_t code) {
    return linear_from_srgb16(code);
}
float linear(float value) {
    return value;
}

template <class T>
std::vector<glm::vec3> texels_of(const Exchange& exchange, const std::vector<T>& samples) {
    const size_t channels = exchange.channels;
    std::vector<glm::vec3> texels(samples.size() / channels);
    for (size_t i = 0; i < texels.size(); ++i)
        for (size_t c = 0; c < 3; ++c)
            texels[i][static_cast<int>(c)] = linear(samples[i * channels + (channels == 3 ? c : 0)]);
    return texels;
}

}  // namespace

ColorPicture oiio_read(const std::string& path) {
    const OiioModule& module = load_oiio_module(path);
    Exchange exchange;
    const OiioHost host = host_of(exchange);
    if (!module.read(path.c_str(), &host)) throw exchange.error(path);
    try {
        return {exchange.width, exchange.height,
                std::visit([&](const auto& samples) { return texels_of(exchange, samples); }, exchange.samples)};
    } catch (const std::bad_alloc&) {
        exchange.out_of_memory = true;
        throw exchange.error(path);
    }
}

}  // namespace cistula
