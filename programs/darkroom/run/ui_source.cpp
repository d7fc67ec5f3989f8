// SPDX-License-Identifier: MIT
#include "ui_source.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <darkroom/hud_inertia.hpp>

#include "image/picture/ui_image.hpp"
#include "report.hpp"

namespace app {

using darkroom::Composer;
using darkroom::Result;

namespace {

/// The first entry of the interface's chain that can be moved.
std::optional<darkroom::Handle> moved_entry(const Composer& composer) {
    for (std::size_t i = 0; i < composer.size(); ++i) {
        const darkroom::Handle entry = composer.entry(i);
        const darkroom::ParamInfo* const row = composer.info(entry)->parameters.find("offset");
        if (composer.desc(entry)->is_ui && row != nullptr && row->kind == darkroom::Kind::Vec2) return entry;
    }
    return std::nullopt;
}

}  // namespace

darkroom::HudValue hud_value(const darkroom::GameValue& value) {
    if (const bool* const toggle = std::get_if<bool>(&value)) return *toggle ? 1.0 : 0.0;
    if (const double* const number = std::get_if<double>(&value)) return *number;
    return std::get<std::string>(value);
}

Result<> move_interface(Composer& composer, darkroom::Vec2 offset) {
    const std::optional<darkroom::Handle> entry = moved_entry(composer);
    if (!entry) return {};
    // On top of where the look has it.
    const auto base = composer.words(*entry).subspan(composer.info(*entry)->parameters.find("offset")->word, 2);
    const std::array words{
        std::bit_cast<std::uint32_t>(std::clamp(std::bit_cast<float>(base[0]) + offset.x, -1.0f, 1.0f)),
        std::bit_cast<std::uint32_t>(std::clamp(std::bit_cast<float>(base[1]) + offset.y, -1.0f, 1.0f))};
    return composer.set_override(*entry, "offset", "inertia", words);
}

darkroom::LookUi interface_of(const darkroom::Look& look) {
    darkroom::LookUi ui = look.ui.value_or(darkroom::LookUi{});
    if (std::filesystem::path(ui.document).extension() != ".svg") return ui;
    const auto document = darkroom::HudDocument::load(ui.document, {.is_headless = true});
    if (!document) return ui;
    for (const std::string& script : (*document)->scripts())
        if (std::ranges::count(ui.controllers, script) == 0) ui.controllers.push_back(script);
    return ui;
}

std::vector<std::filesystem::path> ui_files(const darkroom::Look& look) {
    const darkroom::LookUi ui = interface_of(look);
    std::vector<std::filesystem::path> out(ui.controllers.begin(), ui.controllers.end());
    if (!ui.document.empty()) out.emplace_back(ui.document);
    return out;
}

Result<> check_ui_files(const darkroom::Look& look) {
    for (const std::filesystem::path& file : ui_files(look))
        DARKROOM_TRY(darkroom::read_file(file, {.max_size = 1, .takes_start = true}));
    return {};
}

Result<> UiSource::start(Composer& composer) {
    composer_ = &composer;
    controllers_.reset();
    if (ui_.controllers.empty()) return {};
    const darkroom::LogSink print = [is_silent = is_silent_](darkroom::Severity, std::string_view line) {
        if (!*is_silent) warn(std::string(line));
    };
    console_ = std::make_unique<darkroom::Console>(composer, darkroom::ConsoleDesc{.print = print});
    document_.reset();
    DARKROOM_TRY(load_document());
    const auto set_class = [document = document_](std::string_view id, std::string_view name, bool is_on) {
        return document != nullptr && document->set_class(id, name, is_on);
    };
    // Time is no limit here: what is over one on a busy machine would be another picture. Instructions are counted.
    DARKROOM_TRY_VALUE(auto made,
                       darkroom::Controllers::create(
                           *console_, {.print = print, .milliseconds_per_frame = 1000, .set_class = set_class}));
    controllers_.emplace(std::move(made));
    for (const std::string& file : ui_.controllers) DARKROOM_TRY(controllers_->load(file));
    return {};
}

darkroom::GameTable game_at(darkroom::GameTable game, const std::vector<GameEvent>& events, double time) {
    for (const GameEvent& event : events)
        if (event.time <= time)
            for (const auto& [name, value] : event.values) game.insert_or_assign(name, value);
    return game;
}

// The springs come to rest within seconds, so only what happened lately counts; the steps are exact, so their number
// does not.
darkroom::Vec2 inertia_at(const std::vector<GameEvent>& events, double time) {
    constexpr double memory = 4, longest = darkroom::HudInertia::longest_step;
    darkroom::HudInertia inertia;
    double now = time - memory, yaw = 0;
    bool jumps = false;
    const auto move = [&](double to) {
        while (now < to) {
            const double step = std::min(longest, to - now);
            (void)inertia.step(step, yaw, !jumps, jumps ? 1 : 0);
            jumps = false;
            now += step;
        }
    };
    for (const GameEvent& event : events) {
        if (event.time >= time) break;
        move(event.time);
        if (event.is_teleport) {
            inertia.reset();
            jumps = false;
        }
        jumps |= event.is_jump && event.time > time - memory;
        yaw = event.yaw.value_or(yaw);
    }
    move(time);
    return inertia.offset();
}

Result<> UiSource::advance(Composer& composer, double time) {
    if (ui_.document.empty() && ui_.controllers.empty()) return {};
    if (composer_ != &composer || time < last_time_) DARKROOM_TRY(start(composer));
    last_time_ = time;
    game_ = game_at(ui_.game, events_, time);
    if (!events_.empty()) DARKROOM_TRY(move_interface(composer, inertia_at(events_, time)));
    if (controllers_) controllers_->frame({.time = time, .game = &game_});
    return {};
}

Result<> UiSource::load_document() {
    if (document_ != nullptr || std::filesystem::path(ui_.document).extension() != ".svg") return {};
    DARKROOM_TRY_VALUE(document_, darkroom::HudDocument::load(ui_.document, {.is_headless = true}));
    return {};
}

Result<std::shared_ptr<const std::vector<std::uint8_t>>> UiSource::picture(VkExtent2D extent) {
    if (ui_.document.empty()) return picture_;
    if (std::filesystem::path(ui_.document).extension() == ".svg") {
        DARKROOM_TRY(load_document());
        for (const auto& [name, value] : game_) document_->set(name, hud_value(value));
        const auto drawn = document_->picture(extent.width, extent.height);
        if (drawn == nullptr || !document_->error().empty()) return darkroom::user_error(document_->error());
        picture_ = {drawn, &drawn->rgba};
        return picture_;
    }
    if (extent.width == extent_.width && extent.height == extent_.height) return picture_;
    std::vector<std::string> warnings;
    DARKROOM_TRY_VALUE(auto made, darkroom::read_ui_image(ui_.document, extent.width, extent.height, &warnings));
    if (extent_.width == 0)  // once, whatever sizes follow
        for (const std::string& warning : warnings) warn(warning);
    picture_ = std::make_shared<const std::vector<std::uint8_t>>(std::move(made));
    extent_ = extent;
    return picture_;
}

}  // namespace app
