// SPDX-License-Identifier: MIT
// The C interface by random calls, in any order and with any handle, number and
// text, on a device that is assumed: each call succeeds, or fails with one line
// that can be printed and changes nothing that was to be returned.

#include <darkroom/darkroom.h>
#include <fmt/format.h>

#include <array>
#include <iterator>

#include "fuzz/bytes.hpp"
#include "fuzz/target.hpp"

namespace darkroom::fuzz::c_fuzz {
namespace {

constexpr std::uint32_t max_calls = 64, max_entries = 10, unset = 0xdeadbeef;

class Caller {
  public:
    explicit Caller(std::string_view input) : bytes_(input) {
        darkroom_device_assumed(static_cast<DarkroomDeviceProfile>(bytes_.below(2)), &device_);
        darkroom_composer_create(device_, nullptr, &composer_);
        darkroom_look_default(DARKROOM_LOOK_ORDER_SCENE_LINEAR, &look_);
    }
    Caller(const Caller&) = delete;
    Caller& operator=(const Caller&) = delete;
    ~Caller() {
        darkroom_look_destroy(other_look_);
        darkroom_look_destroy(look_);
        darkroom_composer_destroy(composer_);
        darkroom_device_destroy(device_);
    }

    std::string run() {
        for (std::uint32_t i = 0; i < max_calls && !bytes_.is_empty() && wrong_.empty(); ++i)
            (this->*calls[bytes_.below(calls.size())])();
        return wrong_;
    }

  private:
    using Call = void (Caller::*)();
    static const std::array<Call, 28> calls;

    /// Returns whether it succeeded.
    bool take(DarkroomResult result) {
        if (result == DARKROOM_OK) return true;
        const char* const text = darkroom_error();
        if (wrong_.empty()) wrong_ = text == nullptr ? "an error has no text" : wrong_line(text);
        if (wrong_.empty() && (result < 0 || result > DARKROOM_ERROR_UNSUPPORTED)) wrong_ = "an error has no code";
        // Nothing here asks for more than a machine has.
        if (wrong_.empty() && (result == DARKROOM_ERROR_MACHINE || result == DARKROOM_ERROR_OUT_OF_MEMORY))
            wrong_ = fmt::format("an error of the machine: {}", text);
        return false;
    }
    DarkroomHandle handle() {
        const std::uint32_t pick = bytes_.below(20);
        if (pick == 0) return bytes_.word();
        if (pick < 4) return std::array{DARKROOM_SCENE_COLOR, DARKROOM_SCENE_ALPHA, DARKROOM_UI_LAYER}[pick - 1];
        if (pick < 6) return darkroom_composer_picture_of(resource_);
        DarkroomHandle out = 0;
        std::uint32_t count = 0;
        darkroom_composer_size(composer_, &count);
        if (count > 0) darkroom_composer_entry(composer_, bytes_.below(count), &out);
        return pick == 6 ? darkroom_handle_previous(out) : out;
    }
    DarkroomEffect effect() { return darkroom_effect_at(bytes_.below(darkroom_effect_count())); }
    /// One of the entry's parameters, or any text.
    std::string parameter(DarkroomHandle of) {
        DarkroomEffect found = nullptr;
        if (bytes_.below(8) == 0 || darkroom_composer_info(composer_, of, &found) != DARKROOM_OK) return bytes_.text();
        DarkroomEffectInfo info{.struct_size = sizeof info};
        darkroom_effect_info(found, &info);
        DarkroomParameterInfo row{.struct_size = sizeof row};
        if (info.parameter_count == 0 ||
            darkroom_effect_parameter(found, bytes_.below(info.parameter_count), &row) != DARKROOM_OK)
            return {};
        return row.name;
    }
    std::vector<std::uint32_t> words() {
        std::vector<std::uint32_t> out(bytes_.below(6));
        for (std::uint32_t& word : out) word = bytes_.word();
        return out;
    }

    void add() {
        std::uint32_t count = 0;
        darkroom_composer_size(composer_, &count);
        if (count >= max_entries) return;
        const std::string name = bytes_.text();
        DarkroomEntryDesc desc{.struct_size = sizeof desc};
        desc.blend = static_cast<DarkroomBlendMode>(bytes_.below(10));
        desc.input = bytes_.below(3) == 0 ? handle() : 0;
        desc.source = bytes_.below(3) == 0 ? handle() : 0;
        desc.second = bytes_.below(3) == 0 ? handle() : 0;
        desc.mask = bytes_.below(3) == 0 ? handle() : 0;
        desc.name = name.empty() ? nullptr : name.c_str();
        desc.opacity = static_cast<float>(bytes_.below(4)) / 2;
        desc.is_ui = bytes_.below(5) == 0;
        desc.scale_numerator = bytes_.below(3);
        desc.scale_denominator = bytes_.below(3);
        desc.format = static_cast<VkFormat>(bytes_.below(2) == 0 ? 0 : bytes_.byte());
        DarkroomHandle out = unset;
        const bool is_inserted = bytes_.below(3) == 0;
        const DarkroomHandle before = is_inserted ? handle() : 0;
        DarkroomEffect of = effect();
        const bool is_done = take(is_inserted ? darkroom_composer_insert(composer_, before, of, &desc, &out)
                                              : darkroom_composer_add_effect(composer_, of, &desc, &out));
        if (!is_done && out != unset) wrong_ = "what failed returned a handle";
        if (is_done && darkroom_composer_check(composer_, out) != DARKROOM_OK) wrong_ = "what was added is not there";
    }
    void add_named() { take(darkroom_composer_add(composer_, bytes_.text().c_str(), nullptr, nullptr)); }
    void remove() { take(darkroom_composer_remove(composer_, handle())); }
    void move() {
        const DarkroomHandle of = handle(), before = handle();
        take(darkroom_composer_move(composer_, of, before));
    }
    void replace() {
        const DarkroomHandle of = handle();
        take(darkroom_composer_replace(composer_, of, effect()));
    }
    void rewire() {
        DarkroomEntryDesc desc{.struct_size = sizeof desc};
        const DarkroomHandle of = handle();
        take(darkroom_composer_desc(composer_, of, &desc));
        desc.source = handle();
        take(darkroom_composer_rewire(composer_, of, &desc));
    }
    void clear() { take(darkroom_composer_clear(composer_)); }
    void define_table() {
        std::array<float, 24> numbers{};
        for (float& number : numbers) number = static_cast<float>(bytes_.byte());
        DarkroomTable table{.struct_size = sizeof table};
        table.shaper_size = bytes_.below(4) * 2, table.size = bytes_.below(3);
        table.shaper = numbers.data(), table.cube = numbers.data();
        if (bytes_.below(4) == 0) table.max[0] = bytes_.number();
        take(darkroom_composer_define_table(composer_, &table, &resource_));
    }
    void define_picture() {
        const std::array<float, 16> numbers{1, 0.5F, bytes_.number()};
        const DarkroomPicture picture{sizeof picture, bytes_.below(3), bytes_.below(3), numbers.data()};
        take(darkroom_composer_define_picture(composer_, &picture, &resource_));
    }
    void forget() { take(darkroom_composer_forget(composer_, bytes_.below(2) == 0 ? resource_ : bytes_.word())); }
    void set_enabled() {
        const DarkroomHandle of = handle();
        take(darkroom_composer_set_enabled(composer_, of, bytes_.below(2)));
    }
    void set_opacity() {
        const DarkroomHandle of = handle();
        take(darkroom_composer_set_opacity(composer_, of, bytes_.number()));
    }
    void set_number() {
        const DarkroomHandle of = handle();
        const std::string name = parameter(of);
        take(darkroom_composer_set_number(composer_, of, name.c_str(), bytes_.number()));
    }
    void set_text() {
        const DarkroomHandle of = handle();
        const std::string name = parameter(of), value = bytes_.text();
        take(darkroom_composer_set_text(composer_, of, name.c_str(), value.c_str()));
    }
    void set_words() {
        const DarkroomHandle of = handle();
        const std::string name = parameter(of);
        const std::vector<std::uint32_t> given = words();
        const auto count = static_cast<std::uint32_t>(given.size());
        take(bytes_.below(2) == 0
                 ? darkroom_composer_set_words(composer_, of, name.c_str(), given.data(), count)
                 : darkroom_composer_set_override(composer_, of, name.c_str(), "owner", given.data(), count));
    }
    void set_all() {
        const std::vector<std::uint32_t> given = words();
        take(darkroom_composer_set_all(composer_, handle(), given.data(), static_cast<std::uint32_t>(given.size())));
    }
    void find_parameter() {
        const DarkroomHandle of = handle();
        take(darkroom_composer_parameter(composer_, of, parameter(of).c_str(), &parameter_));
    }
    void set_found() {
        const std::array<float, 4> values{bytes_.number(), bytes_.number(), 0, 1};
        take(darkroom_composer_set_float(composer_, parameter_, values[0]));
        take(darkroom_composer_set_int(composer_, parameter_, static_cast<std::int32_t>(bytes_.byte())));
        take(darkroom_composer_set_vector(composer_, parameter_, values.data(), bytes_.below(5)));
    }
    void drop() { take(darkroom_composer_drop_overrides(composer_, "owner")); }
    void read() {
        const DarkroomHandle of = handle();
        std::array<std::uint32_t, 80> room{};
        auto count = static_cast<std::uint32_t>(bytes_.below(room.size()));
        take(darkroom_composer_words(composer_, of, room.data(), &count));
        count = static_cast<std::uint32_t>(room.size());
        take(darkroom_composer_current(composer_, of, room.data(), &count));
        float opacity = 0;
        take(darkroom_composer_values_at(composer_, of, bytes_.number(), nullptr, nullptr, &count, nullptr, &opacity));
        std::uint32_t frames = 0;
        take(darkroom_composer_pre_roll(composer_, bytes_.number(), &frames));
    }
    void add_pulse() {
        const DarkroomHandle of = handle();
        const std::string name = parameter(of);
        DarkroomPulseDesc desc{.struct_size = sizeof desc};
        desc.event = "hit", desc.entry = of, desc.parameter = name.c_str();
        desc.envelope = static_cast<DarkroomEnvelope>(bytes_.below(4));
        desc.amount[0] = bytes_.number(), desc.duration = bytes_.number();
        take(darkroom_composer_add_pulse(composer_, &desc));
    }
    void fire() {
        const double time = bytes_.number();
        take(darkroom_composer_fire(composer_, "hit", bytes_.below(2) == 0 ? nullptr : &time, nullptr));
    }
    void add_layer() {
        const DarkroomHandle of = handle();
        const std::string name = parameter(of), layer = bytes_.text();
        const std::vector<std::uint32_t> given = words();
        const DarkroomLayerValue value{sizeof value, static_cast<std::uint32_t>(given.size()), of, name.c_str(),
                                       given.data()};
        DarkroomLayerDesc desc{.struct_size = sizeof desc};
        desc.value_count = bytes_.below(2), desc.values = &value, desc.name = layer.c_str(),
        desc.weight = bytes_.number();
        desc.has_distance = bytes_.below(2), desc.far_distance = bytes_.number();
        take(darkroom_composer_add_layer(composer_, &desc));
        take(darkroom_composer_set_layer_weight(composer_, layer.c_str(), bytes_.number()));
        if (bytes_.below(4) == 0) take(darkroom_composer_remove_layer(composer_, layer.c_str()));
        if (bytes_.below(4) == 0) take(darkroom_composer_remove_pulses(composer_));
    }
    void plan() {
        DarkroomCompileDesc desc{.struct_size = sizeof desc};
        desc.max_extent = {bytes_.byte(), bytes_.byte()};
        DarkroomImageUse use{.struct_size = sizeof use};
        use.format = static_cast<VkFormat>(bytes_.byte());
        if (bytes_.below(2) == 0) desc.depth = &use;
        if (bytes_.below(4) == 0) desc.target = &use;
        desc.no_fusion = bytes_.below(2);
        DarkroomPlan made = nullptr;
        if (!take(darkroom_composer_plan(composer_, &desc, &made))) {
            if (made != nullptr) wrong_ = "what failed returned a plan";
            return;
        }
        if (darkroom_plan_text(made) == nullptr || darkroom_plan_json(made) == nullptr) wrong_ = "a plan has no text";
        darkroom_plan_destroy(made);
    }
    void parse_look() {
        DarkroomLookOptions options{.struct_size = sizeof options};
        options.no_tables = VK_TRUE, options.folder = "/nowhere", options.is_strict = bytes_.below(2);
        const std::string text = bytes_.text();
        DarkroomLook made = nullptr;
        if (!take(darkroom_look_parse(text.c_str(), "a", &options, &made))) return;
        darkroom_look_destroy(other_look_);
        other_look_ = made;
    }
    void change_look() {
        const std::string key = bytes_.text(), value = bytes_.text();
        take(darkroom_look_override(look_, key.c_str(), value.c_str()));
        if (bytes_.below(4) == 0) take(darkroom_look_add_ui(look_));
        if (bytes_.below(4) == 0) take(darkroom_look_set_order(look_, static_cast<DarkroomLookOrder>(bytes_.below(3))));
        if (bytes_.below(8) == 0) take(darkroom_look_switch_off(look_));
        if (darkroom_look_write(look_) == nullptr) wrong_ = "a look has no text";
    }
    void apply_look() {
        DarkroomLook of = bytes_.below(2) == 0 && other_look_ != nullptr ? other_look_ : look_;
        take(darkroom_composer_clear(composer_));
        DarkroomApplyOptions options{.struct_size = sizeof options};
        options.keeps_what_is_off = bytes_.below(2);
        if (!take(darkroom_look_apply(of, composer_, &options)) || other_look_ == nullptr) return;
        take(darkroom_look_follow(of, of == look_ ? other_look_ : look_, composer_, &options, nullptr));
    }

    Bytes bytes_;
    DarkroomDevice device_ = nullptr;
    DarkroomComposer composer_ = nullptr;
    DarkroomLook look_ = nullptr, other_look_ = nullptr;
    DarkroomParameter parameter_ = 0;
    std::uint32_t resource_ = 0;
    std::string wrong_;
};

constexpr std::array<Caller::Call, 28> Caller::calls{
    &Caller::add,        &Caller::add,         &Caller::add_named,      &Caller::remove,       &Caller::move,
    &Caller::replace,    &Caller::rewire,      &Caller::clear,          &Caller::define_table, &Caller::define_picture,
    &Caller::forget,     &Caller::set_enabled, &Caller::set_opacity,    &Caller::set_number,   &Caller::set_text,
    &Caller::set_words,  &Caller::set_all,     &Caller::find_parameter, &Caller::set_found,    &Caller::drop,
    &Caller::read,       &Caller::add_pulse,   &Caller::fire,           &Caller::add_layer,    &Caller::plan,
    &Caller::parse_look, &Caller::change_look, &Caller::apply_look};

std::string run(std::string_view input) { return Caller(input).run(); }

std::vector<std::string> seeds() {
    std::vector<std::string> out;
    std::mt19937 random(2);
    for (int i = 0; i < 40; ++i) {
        std::string& seed = out.emplace_back();
        for (int k = 0; k < 40 + 10 * i; ++k) seed += static_cast<char>(random());
    }
    constexpr char calls[] =
        "\0\2bloom\0\2tonemap\0\x1a"
        "bloom_intensity\0"
        "0.2\0\x1b\0\x18\x40\x30";
    out.emplace_back(calls, sizeof calls - 1);
    return out;
}

const Registration c({.name = "c", .run = run, .seeds = seeds, .longest = 1024});

}  // namespace
}  // namespace darkroom::fuzz::c_fuzz
