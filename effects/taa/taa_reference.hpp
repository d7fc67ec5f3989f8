// SPDX-License-Identifier: MIT
#pragma once
// taa in double precision, over sequences: what the page says, pixel by pixel. Nothing is rounded to halves.

#include <algorithm>
#include <array>
#include <cmath>
#include <darkroom/effects/taa.hpp>
#include <darkroom/reference.hpp>

#include "shared/camera_reference.hpp"
#include "shared/finite_reference.hpp"
#include "shared/rcas_reference.hpp"
#include "shared/sample_reference.hpp"
#include "taa/taa_before.hpp"
#include "taa/taa_tone_reference.hpp"

namespace darkroom {

/// Frames that are gathered where nothing moves.
inline double taa_max_frames(const Taa& taa) { return 8 * std::exp2(4 * double{taa.stability}); }

/// Of the Gaussian by which samples count, in pixels of the output: where there is a past, narrower the more samples
/// there are, and where there is none, of a pixel of the frame.
struct TaaExponents {
    explicit TaaExponents(double scale) : narrow(4 * std::pow(scale, -0.75)), wide(1.5 / (scale * scale)) {}
    double narrow, wide;
};

/// Until the frames before the first weigh less than half a code.
inline std::uint32_t taa_pre_roll(const Taa& taa) {
    return static_cast<std::uint32_t>(std::ceil(taa_max_frames(taa) * std::log(2 * 255)));
}

namespace taa {

// The same numbers as in taa.glsl#gather and taa.glsl#mask.
constexpr double edge = 0.03, nearer = 0.02, loss = 2.2, reach = 1.25, still_noise = 3, moving_noise = 0.5,
                 max_noise = 0.5, mask_per_change = 4;

/// One frame of a sequence.
class Gather {
  public:
    Gather(const Taa& taa, const ReferenceInput& input)
        : taa_(taa),
          input_(input),
          picture_(*input.picture),
          width_(input.output_width),
          height_(input.output_height),
          x_scale_(double{1} * picture_.width / width_),
          y_scale_(double{1} * picture_.height / height_),
          stops_(stops_of(input.exposure != nullptr ? finite_reference(input.exposure->pixels[0].r) : 1.0)),
          unit_(std::exp2(stops_)),
          camera_(input.camera),
          depth_before_(taa_depth_before(input.camera)),
          motion_(input.camera),
          distance_(picture_.width, picture_.height) {
        for (std::size_t i = 0; i < distance_.pixels.size(); ++i) {
            const double planar = input.depth->pixels[i].r;
            distance_.pixels[i].r = planar > 0 && planar < 1e9 ? std::min(1 / planar, 65504.0) : 0;
        }
        if (input.history == nullptr || !input.history->contains("shown")) return;
        shown_before_ = &input.history->at("shown");
        kept_before_ = &input.history->at("kept");
        distance_before_ = &input.history->at("distance");
        if (shown_before_->width != width_ || shown_before_->height != height_) shown_before_ = nullptr;
    }

    ReferenceImage run() {
        ReferenceImage light_now(width_, height_), shown_now(width_, height_), kept(width_, height_);
        for (std::uint32_t y = 0; y < height_; ++y)
            for (std::uint32_t x = 0; x < width_; ++x) {
                Rgba& now = shown_now.at(x, y);
                now = gather(x, y, kept.at(x, y));
                const double alpha = sample_reference(picture_, ((x + 0.5) * x_scale_ + jitter(0)) / picture_.width,
                                                      ((y + 0.5) * y_scale_ + jitter(1)) / picture_.height)
                                         .a;
                light_now.at(x, y) = light(now, unit_, alpha);
                now.a = stops_;
            }
        if (input_.history != nullptr) {
            (*input_.history)["shown"] = shown_now;
            (*input_.history)["kept"] = kept;
            (*input_.history)["distance"] = distance_;
        }
        return light_now;
    }

    double unit() const { return unit_; }

  private:
    struct Now {
        Toned color{}, mean{}, deviation{};
        double luma = 0, weight = 0;
    };

    double jitter(std::size_t axis) const { return double{input_.camera.jitter[axis]}; }

    Now now(std::int64_t i0, std::int64_t j0, double away_x, double away_y, double exponent) const {
        Now out;
        Toned squares{};
        double weights = 0;
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) {
                const double dx = (away_x + i) / x_scale_, dy = (away_y + j) / y_scale_;
                const double weight = std::exp(-exponent * (dx * dx + dy * dy));
                const Rgba& texel = picture_.clamped(i0 + i, j0 + j);
                const Toned color = toned({finite_light_reference(texel.r), finite_light_reference(texel.g),
                                           finite_light_reference(texel.b), 1},
                                          unit_);
                if (i == 0 && j == 0) out.luma = color[0];
                out.color = sum(out.color, color, weight);
                out.mean = sum(out.mean, color, 1.0 / 9);
                squares = sum(squares, {color[0] * color[0], color[1] * color[1], color[2] * color[2]}, 1.0 / 9);
                weights += weight;
            }
        out.color = sum({}, out.color, 1 / weights);
        for (std::size_t c = 0; c < 3; ++c)
            out.deviation[c] = std::sqrt(std::max(squares[c] - out.mean[c] * out.mean[c], 0.0));
        out.weight = std::min(weights, 1.0) * exponent / exponents_.narrow;
        return out;
    }

    Toned past(double x, double y) const {
        const double mx = std::floor(x - 0.5) + 0.5, my = std::floor(y - 0.5) + 0.5;
        const Taps of_x(x - mx), of_y(y - my);
        std::array<double, 3> color{};
        double weights = 0, stops = 0;
        for (std::size_t j = 0; j < 5; ++j)
            for (std::size_t i = 0; i < 5; ++i) {
                if (i != 2 && j != 2) continue;  // what lies off the middle of both axes weighs little
                const double weight = of_x.weights[i] * of_y.weights[j];
                const Rgba tap =
                    sample_reference(*shown_before_, (mx + of_x.places[i]) / width_, (my + of_y.places[j]) / height_);
                color = sum(color, {tap.r, tap.g, tap.b}, weight);
                weights += weight;
                stops = tap.a;
            }
        for (double& c : color) c = std::clamp(c / weights, 0.0, 1.0);
        // Under another exposure it was shown as another colour.
        const double scale = 1 / std::lerp(std::exp2(stops_ - stops), 1.0, std::max({color[0], color[1], color[2]}));
        return opponent({color[0] * scale, color[1] * scale, color[2] * scale, 1});
    }

    bool was_hidden(std::int64_t i, std::int64_t j, double inverse, double x, double y) const {
        const ReferenceCamera camera(camera_);
        const double planar = 1 / std::max(inverse, 1e-12);
        const Double3 point = camera.view_position((static_cast<double>(i) + 0.5) / picture_.width,
                                                   (static_cast<double>(j) + 0.5) / picture_.height, planar);
        const Row& row = depth_before_.row;
        const double before = -(row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3]);
        const double expected = inverse > 0 ? 1 / std::max(before, 1e-9) : 0;
        const auto i0 = static_cast<std::int64_t>(std::floor(x - 0.5)),
                   j0 = static_cast<std::int64_t>(std::floor(y - 0.5));
        double farthest = 65504;
        for (int dj = 0; dj < 2; ++dj)
            for (int di = 0; di < 2; ++di) farthest = std::min(farthest, distance_before_->clamped(i0 + di, j0 + dj).r);
        return farthest > expected * (1 + nearer) + 1e-6;
    }

    std::array<double, 2> motion(std::int64_t i, std::int64_t j, double inverse) const {
        if (input_.velocity != nullptr) {
            const Rgba& v = input_.velocity->clamped(i, j);
            return {finite_reference(v.r), finite_reference(v.g)};
        }
        const ReferenceCamera camera(camera_);
        const double u = (static_cast<double>(i) + 0.5) / picture_.width,
                     v = (static_cast<double>(j) + 0.5) / picture_.height;
        const Double3 point = camera.view_position(u, v, 1 / std::max(inverse, 1e-9));
        const auto along = [&](const Row& row) {
            return row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3];
        };
        const double w = along(motion_.rows[2]);
        if (!(w > 0)) return {0, 0};
        const Camera& c = input_.camera;
        return {(along(motion_.rows[0]) / w * 0.5 + 0.5 - u) * picture_.width + double{c.jitter[0]} -
                    double{c.previous_jitter[0]},
                (along(motion_.rows[1]) / w * 0.5 + 0.5 - v) * picture_.height + double{c.jitter[1]} -
                    double{c.previous_jitter[1]}};
    }

    double mask(std::int64_t i, std::int64_t j) const {
        const double given = input_.reactive == nullptr ? 0 : finite_reference(input_.reactive->clamped(i, j).r);
        double change = 0;
        if (input_.transparency != nullptr) {
            const Rgba with = shown(picture_.clamped(i, j)), without = shown(input_.transparency->clamped(i, j));
            change =
                std::max({std::abs(with.r - without.r), std::abs(with.g - without.g), std::abs(with.b - without.b)});
        }
        return std::clamp(std::max(mask_per_change * change, given), 0.0, 1.0);
    }
    Rgba shown(const Rgba& c) const {
        const double r = finite_light_reference(c.r), g = finite_light_reference(c.g), b = finite_light_reference(c.b);
        const double scale = 1 / (unit_ + std::max({r, g, b}));
        return {r * scale, g * scale, b * scale, 1};
    }

    Rgba gather(std::uint32_t x, std::uint32_t y, Rgba& kept) const {
        const double px = (x + 0.5) * x_scale_ + jitter(0), py = (y + 0.5) * y_scale_ + jitter(1);
        const auto inside = [](double v, std::uint32_t n) {
            return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(v)), 0, std::int64_t{n} - 1);
        };
        const std::int64_t i0 = inside(px, picture_.width), j0 = inside(py, picture_.height);
        const double own = distance_.clamped(i0, j0).r;
        double nearest = own, farthest = own;
        std::int64_t at_i = i0, at_j = j0, far_i = i0, far_j = j0;
        constexpr std::array<std::array<int, 2>, 4> beside{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
        for (const auto& [di, dj] : beside) {
            const double here = distance_.clamped(i0 + di, j0 + dj).r;
            const std::int64_t i = std::clamp<std::int64_t>(i0 + di, 0, std::int64_t{picture_.width} - 1),
                               j = std::clamp<std::int64_t>(j0 + dj, 0, std::int64_t{picture_.height} - 1);
            if (here > nearest) nearest = here, at_i = i, at_j = j;
            if (here < farthest) farthest = here, far_i = i, far_j = j;
        }
        const bool is_edge = nearest > own * (1 + edge);
        if (!is_edge) at_i = i0, at_j = j0;
        const double inverse = is_edge ? nearest : own;
        std::array<double, 2> moved = motion(at_i, at_j, inverse);
        moved = {moved[0] / x_scale_, moved[1] / y_scale_};
        const double bx = x + 0.5 + moved[0], by = y + 0.5 + moved[1];
        const double fx = bx - 0.5 - std::floor(bx - 0.5), fy = by - 0.5 - std::floor(by - 0.5);
        double frames = 0, noise = 0, around = 0;
        const bool has_past = shown_before_ != nullptr && bx > 0 && by > 0 && bx < width_ && by < height_;
        if (has_past && !was_hidden(at_i, at_j, inverse, bx * x_scale_ + double{input_.camera.previous_jitter[0]},
                                    by * y_scale_ + double{input_.camera.previous_jitter[1]})) {
            const Rgba before = sample_reference(*kept_before_, bx / width_, by / height_);
            noise = before.g * before.g;
            frames = std::min(before.r * before.r * 128,
                              1 / (1 / taa_max_frames(taa_) + loss * (fx * (1 - fx) + fy * (1 - fy))));
            frames *= 1 - mask(i0, j0);
        }
        const Now frame = now(i0, j0, static_cast<double>(i0) + 0.5 - px, static_cast<double>(j0) + 0.5 - py,
                              std::lerp(exponents_.wide, exponents_.narrow, std::min(frames, 1.0)));
        Toned color = frame.color;
        if (frames > 0) {
            const Toned away = sum(past(bx, by), frame.mean, -1);
            const double of_samples =
                noise * std::lerp(still_noise, moving_noise, std::min(std::hypot(moved[0], moved[1]) * 4, 1.0));
            double beyond = 1;
            for (std::size_t c = 0; c < 3; ++c)
                beyond = std::max(beyond, std::abs(away[c]) / std::max(frame.deviation[c] * reach + of_samples, 1e-3));
            const Toned held = sum(frame.mean, away, 1 / beyond);
            frames /= beyond;
            const double alpha = frame.weight / (frames + frame.weight);
            color = sum(sum({}, held, 1 - alpha), color, alpha);
            const double off = std::min(std::abs(frame.luma - held[0]), max_noise * frame.deviation[0]);
            noise += (off - noise) * std::max(0.1, 1 / (frames + 1));
        }
        std::array<double, 2> behind = motion(far_i, far_j, farthest);
        behind = {behind[0] / x_scale_, behind[1] / y_scale_};
        const double parts = std::clamp(4 * std::hypot(moved[0] - behind[0], moved[1] - behind[1]) - 0.4, 0.0, 1.0);
        noise *= 1 - parts * (is_edge ? 1 : 1 - std::min(4 * std::hypot(behind[0], behind[1]), 1.0));
        for (int dj = -1; dj <= 1; ++dj)
            for (int di = -1; di <= 1; ++di) around = std::max(around, mask(i0 + di, j0 + dj));
        noise *= 1 - around;
        // Roots, as the device keeps and filters them.
        kept = {std::sqrt(std::clamp((frames + frame.weight) / 128, 0.0, 1.0)), std::sqrt(std::min(noise, 1.0)), 0, 1};
        return taa::shown(color);
    }

    const Taa& taa_;
    const ReferenceInput& input_;
    const ReferenceImage& picture_;
    std::uint32_t width_, height_;
    double x_scale_, y_scale_;  ///< pixels of the frame a pixel of the output
    TaaExponents exponents_{1 / std::sqrt(x_scale_ * y_scale_)};
    double stops_, unit_;
    Camera camera_;
    TaaDepthBefore depth_before_;
    TaaMotion motion_;
    ReferenceImage distance_;  ///< inverse, 0 of the sky
    const ReferenceImage *shown_before_ = nullptr, *kept_before_ = nullptr, *distance_before_ = nullptr;
};

/// taa.glsl#sharpen.
inline ReferenceImage sharpened(const ReferenceImage& picture, double strength, double unit) {
    const auto scaled = [](const Rgba& c, double scale) { return Rgba{c.r * scale, c.g * scale, c.b * scale, c.a}; };
    ReferenceImage shown = picture, out = picture;
    for (Rgba& c : shown.pixels) c = scaled(c, 1 / (unit + std::max({c.r, c.g, c.b})));
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x) {
            const auto at = [&](int dx, int dy) { return shown.clamped(std::int64_t{x} + dx, std::int64_t{y} + dy); };
            const Rgba sharp = rcas_reference({at(0, 0), at(0, -1), at(0, 1), at(-1, 0), at(1, 0)}, 1, strength);
            const Rgba light = scaled(sharp, unit / std::max(1 - std::max({sharp.r, sharp.g, sharp.b}), 1e-7));
            out.at(x, y) = {std::min(light.r, 65504.0), std::min(light.g, 65504.0), std::min(light.b, 65504.0),
                            light.a};
        }
    return out;
}

}  // namespace taa

/// How strongly it sharpens: the first step of the slider is three stops less than all.
inline double taa_sharpening(const Taa& taa) { return std::exp2(3 * (double{taa.sharpness} - 1)); }

inline ReferenceImage taa_reference(const void* parameters, const ReferenceInput& input) {
    const Taa& taa = *static_cast<const Taa*>(parameters);
    taa::Gather gather(taa, input);
    const ReferenceImage gathered = gather.run();
    return taa.sharpness == 0 ? gathered : taa::sharpened(gathered, taa_sharpening(taa), gather.unit());
}

}  // namespace darkroom
