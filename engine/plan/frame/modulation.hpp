// SPDX-License-Identifier: MIT
#pragma once
// The layers and pulses of one entry, as a frame evaluates them: without memory of its own.

#include <darkroom/frame.hpp>
#include <darkroom/modulation.hpp>
#include <limits>
#include <span>

namespace darkroom::plan {

/// What modulation depends on.
struct Moment {
    double time = 0;
    std::array<double, 3> eye{};  ///< of the camera, in the world
};
[[nodiscard]] Moment moment_of(double time, const Camera& camera);

/// What an entry has beside its parameters, in one frame.
struct Presence {
    bool is_enabled = true;
    float opacity = 1;
};

struct Layer {
    std::string name;
    float weight = 0;
    std::optional<LayerDistance> distance;
    struct Value {
        const ParamInfo* row = nullptr;
        std::vector<std::uint32_t> words;
    };
    std::vector<Value> values;
    std::optional<bool> is_enabled;
    std::optional<float> opacity;

    [[nodiscard]] double weight_at(const Moment& moment) const;
    /// Blends it over all words of the entry.
    void apply(std::span<std::uint32_t> words, Presence& presence, const Moment& moment) const;
};

struct Pulse {
    std::string event;
    const ParamInfo* row = nullptr;
    std::array<float, 4> amount{};
    Envelope shape = Envelope::Linear;
    double duration = 0;
    double start = std::numeric_limits<double>::infinity();  ///< seconds
    bool is_waiting = false;                                 ///< fired: starts with the next record
};
/// Adds all of them to the words of their entry: each number is rounded and clamped once.
void apply(std::span<const Pulse> pulses, std::span<std::uint32_t> words, const Moment& moment);

/// A value of `row` between two: see LayerDesc.
void interpolate(const ParamInfo& row, std::span<std::uint32_t> under, std::span<const std::uint32_t> over,
                 double weight);

}  // namespace darkroom::plan
