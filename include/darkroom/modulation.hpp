// SPDX-License-Identifier: MIT
#pragma once
// What moves the values of a stack while the picture runs, and leaves its base values alone. A layer is a set of other
// values, blended over the base by a weight; a pulse is added when an event fires it, and dies down. In a frame a value
// is the base, under the layers in the order they were added, plus all pulses, clamped to its range; overrides replace
// it. All of this is a function of the frame's time and camera, so it is the same at any frame rate.

#include <array>
#include <darkroom/handle.hpp>
#include <darkroom/param.hpp>
#include <optional>
#include <string>
#include <vector>

namespace darkroom {

/// Of the amount, with s the share of the duration that has passed, and 0 before and after:
/// Linear 1 - s; Exponential (e^(-5 s) - e^-5) / (1 - e^-5); Spring, a critically damped one that is struck,
/// 10 s (e^(1 - 10 s) - e^-9): it rises from 0 to 1 in a tenth of the duration, and falls.
enum class Envelope : std::uint32_t { Linear, Exponential, Spring };
/// `age`: seconds since the event.
[[nodiscard]] double envelope(Envelope shape, double age, double duration);

struct PulseDesc {
    std::string event;  ///< what fires it
    Handle entry;
    std::string parameter;          ///< made of numbers: no toggle, choice, curve or resource
    std::array<float, 4> amount{};  ///< added to each of its numbers, where the envelope is 1
    Envelope envelope = Envelope::Linear;
    double duration = 0.3;  ///< seconds, above 0
};

/// The weight of a layer by the camera's place: 1 at `near` metres from a point of the world and nearer, 0 from `far`
/// on, linear between them.
struct LayerDistance {
    float near = 0, far = 10;
    Vec3 point;
};
struct LayerValue {
    Handle entry;
    std::string parameter;             ///< of its effect; or the entry's own `enabled` or `opacity`
    std::vector<std::uint32_t> words;  ///< of the parameter's kind
};
/// Floats are interpolated linearly, those of a logarithmic scale in their logarithm; colours and vectors number by
/// number; integers are rounded; curves of as many points point by point. Toggles, choices, other curves and `enabled`
/// switch at a weight of one half. What is read at compile is the base's there; resources are the base's always.
struct LayerDesc {
    std::string name;
    float weight = 0;                       ///< [0, 1], see Composer::set_layer_weight
    std::optional<LayerDistance> distance;  ///< its weight is multiplied
    std::vector<LayerValue> values;
};

}  // namespace darkroom
