// SPDX-License-Identifier: MIT
#include "verify/subject.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <utility>

#include "core/try.hpp"

namespace darkroom::verify {

namespace {

using Words = std::vector<std::uint32_t>;

double between(std::mt19937& random, double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
}

/// The widest ranges would make numbers that no chain of float pictures can hold: about the default, and not beyond
/// what the range allows.
double random_number(std::mt19937& random, const ParamInfo& row, double usual) {
    const double most = std::max({row.range.min * 4, 2 * std::abs(usual), row.kind == Kind::Int ? 6.0 : 2.0});
    return between(random, std::max(row.range.min, -most), std::min(row.range.max, most));
}

void set_curve(std::mt19937& random, const ParamInfo& row, std::span<std::uint32_t> words) {
    constexpr std::uint32_t points = 4;
    words[0] = points;
    for (std::uint32_t i = 0; i < points; ++i) {
        const double x = (i + between(random, 0.1, 0.9)) / points;
        words[1 + i] = std::bit_cast<std::uint32_t>(static_cast<float>(x));
        words[1 + Curve::capacity + i] = std::bit_cast<std::uint32_t>(
            static_cast<float>(between(random, std::max(row.range.min, 0.0), std::min(row.range.max, 1.0))));
    }
}

Words defaults_of(const EffectInfo& info) { return {info.parameters.defaults.begin(), info.parameters.defaults.end()}; }

Words random_words(std::mt19937& random, const EffectInfo& info) {
    Words out = defaults_of(info);
    for (const ParamInfo& row : info.parameters.rows) {
        const std::span<std::uint32_t> words = std::span(out).subspan(row.word, row.words);
        switch (row.kind) {
            case Kind::Resource:
                break;
            case Kind::Toggle:
                words[0] = random() % 2;
                break;
            case Kind::Choice:
                words[0] = static_cast<std::uint32_t>(random() % row.choices.size());
                break;
            case Kind::Curve:
                set_curve(random, row, words);
                break;
            case Kind::Int: {
                const double usual = static_cast<std::int32_t>(words[0]);
                words[0] = static_cast<std::uint32_t>(std::lround(random_number(random, row, usual)));
                break;
            }
            default:
                for (std::uint32_t& word : words) {
                    const double usual{std::bit_cast<float>(word)};
                    word = std::bit_cast<std::uint32_t>(static_cast<float>(random_number(random, row, usual)));
                }
        }
    }
    return out;
}

bool is_allowed(const EffectInfo& info, const Words& words) {
    return info.conflict == nullptr || info.conflict(words.data()).empty();
}

/// Values that are allowed together and that change the picture; the defaults where a hundred tries find none.
Words seen_words(std::mt19937& random, const EffectInfo& info) {
    for (int i = 0; i < 100; ++i) {
        Words words = random_words(random, info);
        if (is_allowed(info, words) && is_seen(info, words)) return words;
    }
    return defaults_of(info);
}

/// An effect of the interface is seen in what joins the two alone.
Subject alone(const EffectInfo& info, std::string name, Words words) {
    Subject out{.name = std::move(name), .steps = {{&info, std::move(words)}}};
    if (info.flat.ui != UiPart::Layer) return out;
    for (const EffectInfo* const other : all_effects())
        if (other->joins_ui()) {
            out.steps.push_back({other, defaults_of(*other)});
            break;
        }
    return out;
}

Subject chain_of(std::string name, std::int32_t FlatPlace::*rank, const std::vector<Subject>& usual) {
    Subject out{.name = std::move(name), .steps = {}};
    for (const Subject& subject : usual)
        if (subject.steps[0].info->flat.*rank >= 0 && subject.steps[0].info->flat.ui != UiPart::Layer)
            out.steps.push_back(subject.steps[0]);
    std::ranges::stable_sort(out.steps, {}, [&](const Step& step) { return step.info->flat.*rank; });
    return out;
}

/// Every other value of a choice or toggle, one at a time: "ssao[method=hemisphere]".
void append_choices(const Subject& usual, std::vector<Subject>& out) {
    constexpr std::array<std::string_view, 2> switches{"false", "true"};
    const EffectInfo& info = *usual.steps[0].info;
    for (const ParamInfo& row : info.parameters.rows) {
        if (row.kind != Kind::Choice && row.kind != Kind::Toggle) continue;
        const std::span<const std::string_view> names = row.kind == Kind::Toggle ? switches : row.choices;
        for (std::uint32_t value = 0; value < names.size(); ++value) {
            Words words = usual.steps[0].words;
            if (std::exchange(words[row.word], value) == value) continue;
            if (!is_allowed(info, words) || !is_seen(info, words)) continue;
            out.push_back(alone(info, fmt::format("{}[{}={}]", info.name, row.name, names[value]), std::move(words)));
        }
    }
}

/// Asks an effect's build() for its tables alone.
class TableFinder final : public PassBuilder {
  public:
    explicit TableFinder(const Step& step) : words_(step.words) {
        if (step.info->build != nullptr) step.info->build(*this);
    }
    [[nodiscard]] bool has_filtered_bytes() const { return has_filtered_bytes_; }

    PassImage table(const TableDesc& desc) override {
        has_filtered_bytes_ |= desc.format == VK_FORMAT_R8G8B8A8_UNORM && !desc.is_load_only;
        return next();
    }
    bool has_frame_image(FrameImage) const override { return true; }
    bool is_depth_planar() const override { return true; }
    bool is_velocity_plain() const override { return true; }
    PassImage shadow_map(std::uint32_t) override { return next(); }
    PassImage picture() override { return next(); }
    PassImage source() override { return next(); }
    std::uint32_t from_max_extent(std::uint32_t (*question)(VkExtent2D)) override { return question({256, 256}); }
    const void* parameters() const override { return words_.data(); }
    bool is_stored(VkFormat) const override { return true; }
    PassImage create(const PassImageDesc&) override { return next(); }
    History history(const PassImageDesc&) override { return {next(), next()}; }
    PassImage frame_image(FrameImage) override { return next(); }
    PassImage shared(std::string_view, PassImage (*make)(PassBuilder&), ConditionFunction) override {
        return make(*this);
    }
    PassImage add(const KernelPassDesc&) override { return next(); }
    void side(std::string, PassImage, PassVector) override {}
    void result(PassImage) override {}

  private:
    PassImage next() { return {next_++}; }

    const Words& words_;
    std::uint32_t next_ = 0;
    bool has_filtered_bytes_ = false;
};

}  // namespace

// The table turns the channels and bends them, so that an axis that is taken for another one shows.
Brought::Brought() : table{.size = 4}, picture{.width = 7, .height = 5, .rgba = {}} {
    for (std::uint32_t i = 0; i < 64; ++i) {
        const float r = static_cast<float>(i % 4) / 3, g = static_cast<float>(i / 4 % 4) / 3,
                    b = static_cast<float>(i / 16) / 3;
        for (const float value : {g * g, 0.75F * b + 0.25F * r, 0.5F * r * g + 0.5F * b}) table.cube.push_back(value);
    }
    for (std::uint32_t i = 0; i < picture.width * picture.height; ++i) {
        const float x = static_cast<float>(i % 7) / 8, y = static_cast<float>(i / 7) / 8;
        for (const float value : {x, 0.25F + y, 0.5F * x + 0.25F * y, 1.0F}) picture.rgba.push_back(value);
    }
}

Brought Brought::disturbed(std::mt19937& random, const Disturbance& by) const {
    Brought out = *this;
    ReferenceImage texels(picture.width, picture.height);
    for (std::size_t i = 0; i < texels.pixels.size(); ++i) {
        const float* const p = picture.rgba.data() + 4 * i;
        texels.pixels[i] = {p[0], p[1], p[2], p[3]};
    }
    Disturbance of_picture = by;
    of_picture.absolute = 1.0 / 255;
    texels = moved(texels, random, of_picture);
    for (std::size_t i = 0; i < texels.pixels.size(); ++i) {
        const Rgba& p = texels.pixels[i];
        const std::array all{p.r, p.g, p.b, p.a};
        std::ranges::transform(all, out.picture.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i),
                               [](double value) { return static_cast<float>(value); });
    }
    return out;
}

bool makes_output(const Subject& subject) {
    return std::ranges::any_of(subject.steps, [](const Step& step) { return step.info->output_scale.is_of_output; });
}

bool filters(const Subject& subject) {
    // What an effect includes of effects/shared filters by what it is handed: a function of its own.
    return std::ranges::any_of(subject.steps, [](const Step& step) {
        const EffectInfo& info = *step.info;
        if (info.touch == Touch::Map || info.touch == Touch::Tap || info.output_scale.denominator != 1 ||
            info.output_scale.is_of_output)
            return true;
        return std::ranges::any_of(info.files, [](const EffectFile& file) {
            return file.text.find("sample_") != std::string_view::npos ||
                   file.text.find("_read(") != std::string_view::npos;
        });
    });
}

bool filters_byte_tables(const Subject& subject) {
    return std::ranges::any_of(subject.steps, [](const Step& step) { return TableFinder(step).has_filtered_bytes(); });
}

bool is_map(const Subject& subject) {
    return std::ranges::any_of(subject.steps, [](const Step& step) { return step.info->touch == Touch::Map; });
}

bool has_curves(const Subject& subject) {
    return std::ranges::any_of(subject.steps, [](const Step& step) {
        return std::ranges::any_of(step.info->files, [](const EffectFile& file) {
            return file.text.find("shared/srgb.glsl") != std::string_view::npos;
        });
    });
}

bool is_seen(const EffectInfo& info, std::span<const std::uint32_t> words) {
    // What is made of a table or a picture is nothing without one: fill() brings it.
    Words with_resources(words.begin(), words.end());
    for (const ParamInfo& row : info.parameters.rows)
        if (row.kind == Kind::Resource) with_resources[row.word] = 1;
    return info.is_identity == nullptr || !info.is_identity(with_resources.data());
}

std::vector<Subject> subjects(const SubjectOptions& options) {
    // An effect has the same values by itself as among all.
    const auto random_for = [&](const EffectInfo& info, std::uint32_t set) {
        std::vector<std::uint32_t> numbers{options.seed, set};
        numbers.insert(numbers.end(), info.name.begin(), info.name.end());
        std::seed_seq sequence(numbers.begin(), numbers.end());
        return std::mt19937(sequence);
    };
    std::vector<Subject> usual;
    for (const EffectInfo* const info : all_effects()) {
        if (!info->reference) continue;
        if (!options.effects.empty() && std::ranges::find(options.effects, info->name) == options.effects.end())
            continue;
        Words words = defaults_of(*info);
        if (!is_seen(*info, words)) {
            std::mt19937 random = random_for(*info, 0);
            words = seen_words(random, *info);
        }
        usual.push_back(alone(*info, std::string(info->name), std::move(words)));
    }
    std::vector<Subject> out = usual;
    if (options.effects.empty()) {
        out.push_back(chain_of("documented", &FlatPlace::documented, usual));
        out.push_back(chain_of("scene_linear", &FlatPlace::scene_linear, usual));
    }
    if (options.has_choices)
        for (const Subject& subject : usual) append_choices(subject, out);
    for (std::uint32_t set = 1; set <= options.random_sets; ++set)
        for (const Subject& subject : usual) {
            const EffectInfo& info = *subject.steps[0].info;
            if (info.parameters.rows.empty()) continue;
            std::mt19937 random = random_for(info, set);
            out.push_back(alone(info, fmt::format("{}[random {}]", info.name, set), seen_words(random, info)));
        }
    return out;
}

Result<> fill(const Subject& subject, Composer& composer, const Brought& brought) {
    for (const Step& step : subject.steps) {
        Words words = step.words;
        for (const ParamInfo& row : step.info->parameters.rows) {
            if (row.kind != Kind::Resource) continue;
            DARKROOM_TRY_VALUE(const Resource made,
                               row.is_picture ? composer.define(brought.picture) : composer.define(brought.table));
            words[row.word] = made.id;
        }
        EntryDesc desc{.is_ui = step.info->flat.ui == UiPart::Layer};
        if (step.info->has_second() && !step.info->joins_ui()) desc.second = scene_alpha;
        composer.add(*step.info, words.data(), desc);
    }
    return {};
}

}  // namespace darkroom::verify
