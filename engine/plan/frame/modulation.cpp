// SPDX-License-Identifier: MIT
#include "plan/frame/modulation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace darkroom {

double envelope(Envelope shape, double age, double duration) {
    const double s = age / duration;
    if (!(s >= 0 && s < 1)) return 0;
    switch (shape) {
        case Envelope::Linear:
            return 1 - s;
        case Envelope::Exponential:
            return (std::exp(-5 * s) - std::exp(-5.0)) / (1 - std::exp(-5.0));
        case Envelope::Spring:
            return 10 * s * (std::exp(1 - 10 * s) - std::exp(-9.0));
    }
    return 0;
}

namespace plan {

namespace {

float number(std::uint32_t word) { return std::bit_cast<float>(word); }
std::uint32_t word(double value) { return std::bit_cast<std::uint32_t>(static_cast<float>(value)); }
std::uint32_t whole_word(double value) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value)));
}
double whole(std::uint32_t word) { return static_cast<double>(static_cast<std::int32_t>(word)); }

void interpolate_curve(std::span<std::uint32_t> under, std::span<const std::uint32_t> over, double weight) {
    if (under[0] != over[0]) {
        if (weight >= 0.5) std::ranges::copy(over, under.begin());
        return;
    }
    for (std::size_t i = 1; i < under.size(); ++i)
        under[i] = word(std::lerp(double{number(under[i])}, double{number(over[i])}, weight));
}

}  // namespace

Moment moment_of(double time, const Camera& camera) {
    // The eye of a matrix that turns and moves alone: -R^T t.
    Moment out{.time = time};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t row = 0; row < 3; ++row)
            out.eye[axis] -= double{camera.view[axis * 4 + row]} * double{camera.view[12 + row]};
    return out;
}

void interpolate(const ParamInfo& row, std::span<std::uint32_t> under, std::span<const std::uint32_t> over,
                 double weight) {
    if (row.kind == Kind::Resource) return;
    if (weight >= 1) {
        std::ranges::copy(over, under.begin());
        return;
    }
    switch (row.kind) {
        case Kind::Toggle:
        case Kind::Choice:
            if (weight >= 0.5) under[0] = over[0];
            return;
        case Kind::Int:
            under[0] = whole_word(std::lerp(whole(under[0]), whole(over[0]), weight));
            return;
        case Kind::Curve:
            return interpolate_curve(under, over, weight);
        default:
            break;
    }
    for (std::size_t i = 0; i < under.size(); ++i) {
        const double a = number(under[i]), b = number(over[i]);
        const bool is_log = row.range.scale == Scale::Log && a > 0 && b > 0;
        under[i] = word(is_log ? a * std::pow(b / a, weight) : std::lerp(a, b, weight));
    }
}

double Layer::weight_at(const Moment& moment) const {
    if (!distance) return weight;
    const auto& [x, y, z] = distance->point;
    const double away = std::hypot(moment.eye[0] - double{x}, moment.eye[1] - double{y}, moment.eye[2] - double{z});
    const double near = distance->near, far = distance->far;
    // NaN counts as far away.
    return away < far ? weight * std::min((far - away) / (far - near), 1.0) : 0;
}

void Layer::apply(std::span<std::uint32_t> words, Presence& presence, const Moment& moment) const {
    const double share = weight_at(moment);
    if (share == 0) return;
    for (const Value& value : values)
        interpolate(*value.row, words.subspan(value.row->word, value.row->words), value.words, share);
    if (is_enabled && share >= 0.5) presence.is_enabled = *is_enabled;
    if (opacity) presence.opacity = static_cast<float>(std::lerp(double{presence.opacity}, double{*opacity}, share));
}

void apply(std::span<const Pulse> pulses, std::span<std::uint32_t> words, const Moment& moment) {
    const auto share_of = [&](const Pulse& pulse) {
        return envelope(pulse.shape, moment.time - pulse.start, pulse.duration);
    };
    for (std::size_t first = 0; first < pulses.size(); ++first) {
        const ParamInfo& row = *pulses[first].row;
        const auto is_done = [&](const Pulse& before) { return before.row == &row && share_of(before) != 0; };
        if (share_of(pulses[first]) == 0 || std::ranges::any_of(pulses.first(first), is_done)) continue;
        for (std::uint32_t i = 0; i < row.words; ++i) {
            std::uint32_t& at = words[row.word + i];
            const bool is_whole = row.kind == Kind::Int;
            double sum = is_whole ? whole(at) : double{number(at)};
            for (const Pulse& pulse : pulses.subspan(first))
                if (pulse.row == &row) sum += double{pulse.amount[i]} * share_of(pulse);
            const double value = std::clamp(sum, row.range.min, row.range.max);
            at = is_whole ? whole_word(value) : word(value);
        }
    }
}

}  // namespace plan

}  // namespace darkroom
