// SPDX-License-Identifier: MIT
// The values of a composer's entries, and what moves them.
#include <bit>
#include <darkroom/ui_constants.hpp>

#include "c/frame_of.hpp"
#include "core/text/param_text.hpp"

namespace darkroom::c {

namespace {

Result<std::span<const std::uint32_t>> words_of(const std::uint32_t* words, std::uint32_t count) {
    if (words == nullptr) return is_null("words");
    if (count > max_elements) return user_error(fmt::format("{} words: allowed are at most {}", count, max_elements));
    return std::span(words, count);
}

ParameterId id_of(DarkroomParameter parameter) {
    return {static_cast<std::uint32_t>(parameter), static_cast<std::uint16_t>(parameter >> 32),
            static_cast<std::uint16_t>(parameter >> 48)};
}
DarkroomParameter number_of(ParameterId id) {
    return id.owner | DarkroomParameter{id.row} << 32 | DarkroomParameter{id.place} << 48;
}

}  // namespace

}  // namespace darkroom::c

using namespace darkroom;
using namespace darkroom::c;

DarkroomResult darkroom_composer_set_enabled(DarkroomComposer composer, DarkroomHandle handle, VkBool32 is_enabled) {
    return call("darkroom_composer_set_enabled", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        return composer->composer.set_enabled(handle_of(handle), is_enabled != 0);
    });
}

DarkroomResult darkroom_composer_set_opacity(DarkroomComposer composer, DarkroomHandle handle, float opacity) {
    return call("darkroom_composer_set_opacity", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        return composer->composer.set_opacity(handle_of(handle), opacity);
    });
}

DarkroomResult darkroom_composer_set_number(DarkroomComposer composer, DarkroomHandle handle, const char* parameter,
                                            double value) {
    return call("darkroom_composer_set_number", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "parameter", parameter));
        const EffectInfo* const info = composer->composer.info(handle_of(handle));
        const ParamInfo* const row = info == nullptr ? nullptr : info->parameters.find(parameter);
        if (row != nullptr && (row->kind == Kind::Toggle || row->kind == Kind::Choice || row->kind == Kind::Resource)) {
            const bool is_whole = value >= 0 && value <= 4294967295.0 && value == static_cast<std::uint32_t>(value);
            if (!is_whole)
                return user_error(fmt::format("{} = {}: allowed is a whole number from 0 on", parameter, value));
            const auto word = static_cast<std::uint32_t>(value);
            return composer->composer.set(handle_of(handle), parameter, std::span(&word, 1));
        }
        return composer->composer.set(handle_of(handle), parameter, value);
    });
}

DarkroomResult darkroom_composer_set_text(DarkroomComposer composer, DarkroomHandle handle, const char* parameter,
                                          const char* value) {
    return call("darkroom_composer_set_text", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "parameter", parameter, "value", value));
        Composer& stack = composer->composer;
        DARKROOM_TRY_VALUE(const auto id, stack.parameter(handle_of(handle), parameter));
        const ParamInfo& row = stack.info(handle_of(handle))->parameters.rows[id.row];
        const std::string shown = fmt::format("{}.{}", stack.desc(handle_of(handle))->name, row.name);
        const auto parsed = parse_text(row, value);
        if (!parsed) return user_error(fmt::format("{} = '{}': {}", shown, value, parsed.error().text));
        const auto base = stack.words(handle_of(handle));
        std::vector<std::uint32_t> words(base.begin(), base.end());
        DARKROOM_TRY(assign(row, words, *parsed, shown));
        // A size in % sets the row of its reach, too.
        for (const ParamInfo& changed : stack.info(handle_of(handle))->parameters.rows) {
            const auto is = std::span<const std::uint32_t>(words).subspan(changed.word, changed.words);
            if (std::ranges::equal(is, stack.words(handle_of(handle)).subspan(changed.word, changed.words))) continue;
            DARKROOM_TRY(stack.set(handle_of(handle), changed.name, is));
        }
        return {};
    });
}

DarkroomResult darkroom_composer_set_words(DarkroomComposer composer, DarkroomHandle handle, const char* parameter,
                                           const uint32_t* words, uint32_t count) {
    return call("darkroom_composer_set_words", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "parameter", parameter));
        DARKROOM_TRY_VALUE(const auto given, words_of(words, count));
        return composer->composer.set(handle_of(handle), parameter, given);
    });
}

DarkroomResult darkroom_composer_set_all(DarkroomComposer composer, DarkroomHandle handle, const uint32_t* words,
                                         uint32_t count) {
    return call("darkroom_composer_set_all", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        DARKROOM_TRY(words_of(words, count));
        DARKROOM_TRY(composer->composer.check(handle_of(handle)));
        const EffectInfo& info = *composer->composer.info(handle_of(handle));
        if (count != info.parameters.words())
            return user_error(fmt::format("count = {}: {} has {} words", count, info.name, info.parameters.words()));
        return composer->composer.set(handle_of(handle), info, words);
    });
}

DarkroomResult darkroom_composer_parameter(DarkroomComposer composer, DarkroomHandle handle, const char* name,
                                           DarkroomParameter* parameter) {
    return call("darkroom_composer_parameter", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "name", name, "parameter", parameter));
        DARKROOM_TRY_VALUE(const auto id, composer->composer.parameter(handle_of(handle), name));
        *parameter = number_of(id);
        return {};
    });
}

DarkroomResult darkroom_composer_set_float(DarkroomComposer composer, DarkroomParameter parameter, float value) {
    return call("darkroom_composer_set_float", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        const auto word = std::bit_cast<std::uint32_t>(value);
        return composer->composer.set(id_of(parameter), std::span(&word, 1));
    });
}

DarkroomResult darkroom_composer_set_int(DarkroomComposer composer, DarkroomParameter parameter, int32_t value) {
    return call("darkroom_composer_set_int", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        const auto word = std::bit_cast<std::uint32_t>(value);
        return composer->composer.set(id_of(parameter), std::span(&word, 1));
    });
}

DarkroomResult darkroom_composer_set_vector(DarkroomComposer composer, DarkroomParameter parameter, const float* values,
                                            uint32_t count) {
    return call("darkroom_composer_set_vector", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "values", values));
        if (count < 1 || count > 4) return user_error(fmt::format("count = {}: allowed is 1 to 4", count));
        std::array<std::uint32_t, 4> words{};
        std::memcpy(words.data(), values, count * sizeof(float));
        return composer->composer.set(id_of(parameter), std::span(words).first(count));
    });
}

DarkroomResult darkroom_composer_set_override(DarkroomComposer composer, DarkroomHandle handle, const char* parameter,
                                              const char* owner, const uint32_t* words, uint32_t count) {
    return call("darkroom_composer_set_override", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "parameter", parameter, "owner", owner));
        DARKROOM_TRY_VALUE(const auto given, words_of(words, count));
        return composer->composer.set_override(handle_of(handle), parameter, owner, given);
    });
}

DarkroomResult darkroom_composer_drop_overrides(DarkroomComposer composer, const char* owner) {
    return call("darkroom_composer_drop_overrides", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "owner", owner));
        composer->composer.drop_overrides(owner);
        return {};
    });
}

DarkroomResult darkroom_composer_current(DarkroomComposer composer, DarkroomHandle handle, uint32_t* words,
                                         uint32_t* count) {
    return call("darkroom_composer_current", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "count", count));
        DARKROOM_TRY(composer->composer.check(handle_of(handle)));
        const auto now = composer->composer.current(handle_of(handle));
        write_all<std::uint32_t>(now, words, count);
        return {};
    });
}

DarkroomResult darkroom_composer_values_at(DarkroomComposer composer, DarkroomHandle handle, double time,
                                           const DarkroomCamera* given, uint32_t* words, uint32_t* count,
                                           VkBool32* is_enabled, float* opacity) {
    return call("darkroom_composer_values_at", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "count", count));
        DARKROOM_TRY(composer->composer.check(handle_of(handle)));
        DARKROOM_TRY_VALUE(const auto camera, camera_of(given));
        const auto values = composer->composer.values_at(handle_of(handle), time, camera);
        write_all<std::uint32_t>(values.words, words, count);
        if (is_enabled != nullptr) *is_enabled = values.is_enabled;
        if (opacity != nullptr) *opacity = values.opacity;
        return {};
    });
}

DarkroomResult darkroom_composer_pre_roll(DarkroomComposer composer, double delta_time, uint32_t* frames) {
    return call("darkroom_composer_pre_roll", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "frames", frames));
        *frames = composer->composer.pre_roll(delta_time);
        return {};
    });
}

double darkroom_envelope(DarkroomEnvelope shape, double age, double duration) {
    return call_for("darkroom_envelope", 0.0, [&] {
        const auto kind = enumerator<Envelope>(shape, DARKROOM_ENVELOPE_SPRING, "shape");
        return kind ? envelope(*kind, age, duration) : 0.0;
    });
}

DarkroomResult darkroom_composer_add_pulse(DarkroomComposer composer, const DarkroomPulseDesc* given) {
    return call("darkroom_composer_add_pulse", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "desc", given));
        DARKROOM_TRY_VALUE(const auto desc, read(given, "DarkroomPulseDesc"));
        DARKROOM_TRY(needs("event", desc.event, "parameter", desc.parameter));
        DARKROOM_TRY_VALUE(const auto kind, enumerator<Envelope>(desc.envelope, DARKROOM_ENVELOPE_SPRING, "envelope"));
        PulseDesc out{
            .event = desc.event, .entry = handle_of(desc.entry), .parameter = desc.parameter, .envelope = kind};
        std::ranges::copy(desc.amount, out.amount.begin());
        if (desc.duration != 0) out.duration = desc.duration;
        return composer->composer.add_pulse(out);
    });
}

DarkroomResult darkroom_composer_fire(DarkroomComposer composer, const char* event, const double* time,
                                      uint32_t* count) {
    return call("darkroom_composer_fire", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "event", event));
        const std::size_t fired =
            time == nullptr ? composer->composer.fire(event) : composer->composer.fire(event, *time);
        if (count != nullptr) *count = static_cast<std::uint32_t>(fired);
        return {};
    });
}

DarkroomResult darkroom_composer_add_layer(DarkroomComposer composer, const DarkroomLayerDesc* given) {
    return call("darkroom_composer_add_layer", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "desc", given));
        DARKROOM_TRY_VALUE(const auto desc, read(given, "DarkroomLayerDesc"));
        DARKROOM_TRY(needs("name", desc.name));
        LayerDesc out{.name = desc.name, .weight = desc.weight};
        if (desc.has_distance != 0)
            out.distance = LayerDistance{.near = desc.near_distance,
                                         .far = desc.far_distance,
                                         .point = {desc.point[0], desc.point[1], desc.point[2]}};
        DARKROOM_TRY_VALUE(const auto values, read_all(desc.values, desc.value_count, "DarkroomLayerValue"));
        for (const DarkroomLayerValue& value : values) {
            DARKROOM_TRY_VALUE(const auto words, words_of(value.words, value.word_count));
            DARKROOM_TRY(needs("parameter", value.parameter));
            out.values.push_back({handle_of(value.entry), value.parameter, {words.begin(), words.end()}});
        }
        return composer->composer.add_layer(out);
    });
}

DarkroomResult darkroom_composer_set_layer_weight(DarkroomComposer composer, const char* name, float weight) {
    return call("darkroom_composer_set_layer_weight", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "name", name));
        return composer->composer.set_layer_weight(name, weight);
    });
}

const char* darkroom_composer_layer_name(DarkroomComposer composer, uint32_t index) {
    return call_for<const char*>("darkroom_composer_layer_name", nullptr, [&]() -> const char* {
        if (composer == nullptr) return nullptr;
        composer->texts = composer->composer.layer_names();
        return index < composer->texts.size() ? composer->texts[index].c_str() : nullptr;
    });
}

DarkroomResult darkroom_composer_remove_pulses(DarkroomComposer composer) {
    return call("darkroom_composer_remove_pulses", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer));
        composer->composer.remove_pulses();
        return {};
    });
}

DarkroomResult darkroom_composer_remove_layer(DarkroomComposer composer, const char* name) {
    return call("darkroom_composer_remove_layer", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "name", name));
        composer->composer.remove_layer(name);
        return {};
    });
}

DarkroomResult darkroom_composer_set_ui_constants(DarkroomComposer composer, const float constants[10],
                                                  uint32_t height) {
    return call("darkroom_composer_set_ui_constants", [&]() -> Result<> {
        DARKROOM_TRY(needs("composer", composer, "constants", constants));
        DarkroomUiConstants out{};
        std::memcpy(&out, constants, sizeof out);
        return set_ui_constants(composer->composer, out, height);
    });
}
