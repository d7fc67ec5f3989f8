// SPDX-License-Identifier: MIT
#include "lut_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "develop/reference_chain.hpp"
#include "looks/look_parts.hpp"
#include "tables/evaluate.hpp"
#include "tables/log_shaper.hpp"

namespace app {

using darkroom::Domain;
using darkroom::failure;
using darkroom::LogShaper;
using darkroom::Look;
using darkroom::LookEntry;
using darkroom::ReferenceImage;
using darkroom::Result;
using darkroom::Rgba;
using darkroom::TableColor;

namespace {

constexpr std::uint32_t edge = 65;

struct Moment {
    double time = 0;
    std::uint64_t frame = 0;
};

Result<ReferenceImage> developed(const Look& look, const ReferenceImage& picture, Domain target, bool encodes,
                                 const Moment& moment = {}) {
    darkroom::Composer composer(darkroom::Device::assumed());
    DARKROOM_TRY(apply(look, composer));
    DARKROOM_TRY_VALUE(auto out, run_reference(composer, {.color = &picture,
                                                          .time = moment.time,
                                                          .frame_index = moment.frame,
                                                          .target_domain = target,
                                                          .encodes_target = encodes}));
    return std::move(out.picture);
}

bool is_same(const Rgba& a, const Rgba& b) {
    const auto near = [](double x, double y) { return std::abs(x - y) <= 1e-9 * std::max(1.0, std::abs(y)); };
    return near(a.r, b.r) && near(a.g, b.g) && near(a.b, b.b);
}

/// Why an entry is no function of a colour alone; empty: it is one. What effects say of themselves comes first, and
/// then what they do: a pixel of many is to become what a picture of its colour alone becomes, whenever that is.
Result<std::string> obstacle(const LookEntry& entry) {
    const darkroom::EffectInfo& effect = *entry.effect;
    for (const darkroom::WireInfo& wire : darkroom::wires)
        if (wire.is_reference && !(entry.*wire.member).empty())
            return fmt::format("is wired to {}", entry.*wire.member);
    if (effect.needs.contains(darkroom::FrameImage::Depth)) return "reads the depth";
    if (effect.needs.bits != 0 || effect.has_second()) return "reads another picture";
    if (effect.touch != darkroom::Touch::Pointwise || !effect.reference) return "reads other pixels than its own";
    Look alone{.is_flat = false, .entries = {entry}, .shown_name = "the look"};
    std::mt19937 random(5);
    std::uniform_real_distribution<double> stops(-8, 5);
    // Large enough for pyramids of a few levels.
    ReferenceImage picture(40, 36);
    for (Rgba& color : picture.pixels)
        color = {std::exp2(stops(random)), std::exp2(stops(random)), std::exp2(stops(random)), 1};
    const auto of = [&](const ReferenceImage& image, const Moment& moment) {
        return developed(alone, image, Domain::Encoded, false, moment);
    };
    const auto many = of(picture, {}), later = of(picture, {.time = 1.7, .frame = 41});
    if (!many || !later) return failure(many ? later.error() : many.error());
    for (std::size_t i = 0; i < picture.pixels.size(); i += 97) {
        DARKROOM_TRY_VALUE(const auto one, of(ReferenceImage(1, 1, picture.pixels[i]), {}));
        if (!is_same(many->pixels[i], one.pixels[0]))
            return "depends on the place in the picture, or on its surroundings";
    }
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        if (!is_same(many->pixels[i], later->pixels[i])) return "depends on the time";
    return std::string();
}

/// What comes out of the look, as numbers of a table.
class Baker {
  public:
    explicit Baker(const Look& look) : look_(look) {
        Domain domain = Domain::SceneLinear;
        for (const LookEntry* const entry : darkroom::ordered(look_))
            if (entry->effect->makes != nullptr && entry->state.enabled.on != 0)
                domain = entry->effect->makes({.domain = domain}, entry->words.data()).domain;
        is_scene_ = domain == Domain::SceneLinear;
    }

    [[nodiscard]] bool is_scene() const { return is_scene_; }

    [[nodiscard]] Result<std::vector<TableColor>> bake(const std::vector<TableColor>& light) const {
        ReferenceImage picture(static_cast<std::uint32_t>(light.size()), 1);
        for (std::size_t i = 0; i < light.size(); ++i) picture.pixels[i] = {light[i][0], light[i][1], light[i][2], 1};
        DARKROOM_TRY_VALUE(const auto out,
                           developed(look_, picture, is_scene_ ? Domain::SceneLinear : Domain::Encoded, true));
        std::vector<TableColor> found;
        for (const Rgba& color : out.pixels) {
            TableColor values{color.r, color.g, color.b};
            for (double& value : values) value = is_scene_ ? LogShaper::encode(value) : std::clamp(value, 0.0, 1.0);
            found.push_back(values);
        }
        return found;
    }

  private:
    const Look& look_;
    bool is_scene_ = false;
};

/// The largest and the mean difference of the table from the look, on random colours of all that it holds.
Result<std::pair<double, double>> error_of(const darkroom::ColorTable& table, const Baker& baker) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<TableColor> given(20000), light = given;
    for (std::size_t n = 0; n < given.size(); ++n)
        for (std::size_t i = 0; i < 3; ++i) light[n][i] = LogShaper::decode(given[n][i] = unit(random));
    DARKROOM_TRY_VALUE(const auto expected, baker.bake(light));
    double largest = 0, sum = 0;
    for (std::size_t n = 0; n < given.size(); ++n) {
        const TableColor found = evaluate(table, given[n]);
        for (std::size_t i = 0; i < 3; ++i) {
            const double difference = std::abs(found[i] - expected[n][i]);
            largest = std::max(largest, difference);
            sum += difference;
        }
    }
    return std::pair(largest, sum / (3.0 * static_cast<double>(given.size())));
}

}  // namespace

Result<ExportedLook> export_look(const Look& look) {
    ExportedLook out;
    Look kept = look;
    kept.entries.clear();
    const std::vector<std::string> names = entry_names(look);
    for (const LookEntry* const entry : darkroom::ordered(look)) {
        const darkroom::EffectInfo& effect = *entry->effect;
        if (look.is_enabled && (entry->state.enabled.on == 0 ||
                                (effect.is_identity != nullptr && effect.is_identity(entry->words.data()))))
            continue;
        DARKROOM_TRY_VALUE(const std::string why, obstacle(*entry));
        if (why.empty()) {
            kept.entries.push_back(*entry);
            continue;
        }
        // A look that is off is made of its exposure and what changes the domain, and of nothing else.
        if (look.is_enabled)
            out.left_out.push_back(
                fmt::format("{}: {}", names[static_cast<std::size_t>(entry - look.entries.data())], why));
    }
    if (kept.entries.empty())
        return darkroom::user_error(fmt::format(
            "{}: none of its effects maps colour to colour alone; a table holds nothing else", look.shown_name));
    const Baker baker(kept);
    std::vector<TableColor> light;
    const auto node = [](std::uint32_t i) { return LogShaper::decode(i / (edge - 1.0)); };
    for (std::uint32_t b = 0; b < edge; ++b)
        for (std::uint32_t g = 0; g < edge; ++g)
            for (std::uint32_t r = 0; r < edge; ++r) light.push_back({node(r), node(g), node(b)});
    DARKROOM_TRY_VALUE(const auto baked, baker.bake(light));
    out.file.table.size = edge;
    for (const TableColor& color : baked)
        for (const double value : color) out.file.table.cube.push_back(static_cast<float>(value));
    DARKROOM_TRY_VALUE(const auto error, error_of(out.file.table, baker));
    out.file.title = std::filesystem::path(look.shown_name).stem().string();
    out.file.comments = {
        fmt::format("Input: scene-linear Rec. 709 by (log2(c / {}) + {}) / {}, so that 0 to 1 are {} to {:+} stops",
                    LogShaper::grey, -LogShaper::lowest_stop, LogShaper::highest_stop - LogShaper::lowest_stop,
                    LogShaper::lowest_stop, LogShaper::highest_stop),
        baker.is_scene() ? "Output: the same as the input" : "Output: code values of the display",
        fmt::format("Parameters: space = \"scene_linear\", result = \"{}\"", baker.is_scene() ? "same" : "display"),
        fmt::format("Error on 20000 random colours: largest {:.6f}, mean {:.6f}, of 1", error.first, error.second)};
    for (const std::string& line : out.left_out) out.file.comments.push_back("Left out: " + line);
    return out;
}

}  // namespace app
