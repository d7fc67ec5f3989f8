// SPDX-License-Identifier: MIT
#include <darkroom/hud_document.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <optional>
#include <system_error>
#include <thread>

#include "core/files.hpp"
#include "core/text/param_text.hpp"
#include "core/thread/parallel.hpp"
#include "hud/svg_process.hpp"
#include "hud/svg_text.hpp"

namespace darkroom {

namespace {

using Clock = std::chrono::steady_clock;
using Template = std::shared_ptr<const SvgTemplate>;

/// What a drawing is made of; two that are equal are the same picture.
struct Wish {
    Template document;
    std::uint32_t width = 0, height = 0;
    float scale = 1;
    std::uint64_t values = 0;  ///< counts their changes, and those of classes
    bool operator==(const Wish&) const = default;
};

struct Shown {
    HudValues values;
    HudClasses classes;
};

struct Outcome {
    Wish wish;
    Result<std::shared_ptr<const HudPicture>> picture;
};

/// "12: reason" of "... on line 12 column 3 ...: reason", or "reason".
std::string located(std::string text) {
    text.erase(text.find_last_not_of(" \n.") + 1);
    constexpr std::string_view mark = " on line ";
    const std::size_t at = text.find(mark);
    if (at == std::string::npos) return text;
    std::size_t line = 0;
    std::from_chars(text.data() + at + mark.size(), text.data() + text.size(), line);
    const std::size_t reason = text.find(": ", at);
    return fmt::format("{}: {}", line, reason == std::string::npos ? text : text.substr(reason + 2));
}

}  // namespace

struct HudDocument::State {
    State(std::filesystem::path file, const HudOptions& hud_options)
        : path(std::move(file)), options(hud_options), process(hud_options.limits) {}

    ~State() {
        {
            const std::lock_guard lock(mutex);
            is_over = true;
        }
        process.cancel();
        wakes.notify_all();
        if (worker.joinable()) worker.join();
    }

    [[nodiscard]] std::string placed(std::string_view reason) const {
        return fmt::format("{}:{}{}", printable(path.string()),
                           !reason.empty() && reason[0] >= '0' && reason[0] <= '9' ? "" : " ", reason);
    }

    [[nodiscard]] Result<Template> read() {
        DARKROOM_TRY_VALUE(const auto bytes, read_file(path, {.max_size = options.limits.document_bytes}));
        std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        SvgFacts facts;
        if (auto checked = check_svg(text, options.limits.elements, &facts); !checked)
            return user_error(placed(checked.error().text));
        auto parsed = SvgTemplate::parse(std::move(text));
        if (!parsed) return user_error(placed(parsed.error().text));
        for (std::string& name : facts.scripts) name = (path.parent_path() / name).string();
        scripts = std::move(facts.scripts);
        return std::make_shared<const SvgTemplate>(std::move(*parsed));
    }

    [[nodiscard]] Result<std::shared_ptr<const HudPicture>> draw(const Wish& wish, const Shown& with) {
        auto text = wish.document->fill(with.values);
        SvgFacts facts;
        // Values stand in attributes too, and so in references.
        if (text)
            if (auto checked = check_svg(*text, options.limits.elements, &facts); !checked)
                text = failure(std::move(checked));
        if (!text) return user_error(placed(text.error().text));
        // The place behind the root's name comes before all others, and stays.
        const std::string sized =
            at_size(with_classes(std::move(*text), facts, with.classes), facts, wish.width, wish.height, wish.scale);
        auto made = process.draw(sized, wish.width, wish.height);
        if (!made) return failure(Error{made.error().fault, placed(printable(located(made.error().text)))});
        return std::make_shared<const HudPicture>(std::move(*made));
    }

    void look_at_file() {
        const auto now = Clock::now();
        if (!options.is_headless && std::chrono::duration<double>(now - looked).count() < options.poll_seconds) return;
        looked = now;
        const FileStamp found = stamp_of(path);
        if (found == stamp) return;
        stamp = found;
        auto read_anew = read();
        file_error = read_anew ? std::string() : read_anew.error().text;
        if (read_anew) latest = std::move(*read_anew);
    }

    void take(Outcome outcome) {
        const bool is_latest = outcome.wish.document == latest;
        if (outcome.picture) {
            ++drawings;
            picture = std::move(*outcome.picture);
            drawn = outcome.wish;
            draw_error.clear();
            if (is_latest) good = latest;
            return;
        }
        draw_error = outcome.picture.error().text;
        failed = outcome.wish;
        // A new document that cannot be drawn gives way to the last good one.
        if (is_latest && good != nullptr && good != latest) {
            file_error = std::exchange(draw_error, {});
            latest = good;
        }
    }

    /// False: no thread can be started, so that the caller has to draw.
    [[nodiscard]] bool ask(Wish wish) {
        if (!worker.joinable()) {
            auto started = start_thread([this] { work(); });
            if (!started) return false;
            worker = std::move(*started);
        }
        {
            const std::lock_guard lock(mutex);
            if (is_busy) return true;
            job = std::move(wish);
            job_shown = shown;
            is_busy = true;
        }
        wakes.notify_all();
        return true;
    }

    void take_done() {
        std::optional<Outcome> taken;
        {
            const std::lock_guard lock(mutex);
            taken = std::exchange(done, std::nullopt);
            if (taken) is_busy = false;
        }
        if (taken) take(std::move(*taken));
    }

    void work() {
        std::unique_lock lock(mutex);
        while (!is_over) {
            if (!job) {
                wakes.wait(lock);
                continue;
            }
            const Wish wish = *std::exchange(job, std::nullopt);
            const Shown with = std::move(job_shown);
            lock.unlock();
            // Whatever a document makes this thread do, it goes on.
            Outcome outcome{wish, [&]() -> Result<std::shared_ptr<const HudPicture>> {
                                try {
                                    return draw(wish, with);
                                } catch (const std::exception& exception) {
                                    return machine_error(placed(exception.what()));
                                }
                            }()};
            lock.lock();
            done = std::move(outcome);
        }
    }

    std::filesystem::path path;
    HudOptions options;
    // Of the caller's thread:
    Shown shown;
    std::uint64_t value_changes = 0, drawings = 0;
    Template latest, good;  // as the file was read last; as it was drawn last
    std::shared_ptr<const HudPicture> picture;
    Wish drawn, failed;
    std::vector<std::string> scripts;
    std::string file_error, draw_error;
    FileStamp stamp;
    Clock::time_point looked{};
    // Used by the thread that draws: the worker, or the caller if there is no worker.
    SvgProcess process;
    // Between both, under the mutex. Busy from a job to the taking of its outcome.
    std::mutex mutex;
    std::condition_variable wakes;
    std::optional<Wish> job;
    Shown job_shown;
    std::optional<Outcome> done;
    bool is_busy = false, is_over = false;
    std::jthread worker;
};

HudDocument::HudDocument(std::unique_ptr<State> state) : state_(std::move(state)) {}
HudDocument::~HudDocument() = default;

Result<std::unique_ptr<HudDocument>> HudDocument::load(const std::filesystem::path& path, const HudOptions& options) {
    auto state = std::make_unique<State>(path, options);
    state->stamp = stamp_of(path);
    state->looked = Clock::now();
    DARKROOM_TRY_VALUE(state->latest, state->read());
    return std::unique_ptr<HudDocument>(new HudDocument(std::move(state)));
}

void HudDocument::set(std::string_view name, HudValue value) {
    // A NaN differs from itself, and would be drawn in every frame.
    if (const double* const number = std::get_if<double>(&value); number != nullptr && std::isnan(*number))
        value = std::string("nan");
    const auto found = state_->shown.values.find(name);
    if (found != state_->shown.values.end() && found->second == value) return;
    const HudValue* const before = found == state_->shown.values.end() ? nullptr : &found->second;
    const auto shows = [&](const Template& document) {
        return document != nullptr && document->shows(name, before, value);
    };
    if (shows(state_->latest) || shows(state_->good)) ++state_->value_changes;
    if (found != state_->shown.values.end())
        found->second = std::move(value);
    else
        state_->shown.values.emplace(name, std::move(value));
}

bool HudDocument::set_class(std::string_view id, std::string_view name, bool is_on) {
    constexpr std::size_t most = 256, longest = 64;
    const auto is_word = [](std::string_view text) {
        const auto is_of_it = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; };
        return !text.empty() && text.size() <= longest && std::ranges::all_of(text, is_of_it);
    };
    if (!is_word(id) || !is_word(name)) return false;
    HudClasses& classes = state_->shown.classes;
    const auto [found, is_new] = classes.try_emplace({std::string(id), std::string(name)}, !is_on);
    if (is_new && classes.size() > most) {
        classes.erase(found);
        return false;
    }
    state_->value_changes += found->second != is_on ? 1 : 0;
    found->second = is_on;
    return true;
}

std::shared_ptr<const HudPicture> HudDocument::picture(std::uint32_t width, std::uint32_t height, float scale) {
    State& state = *state_;
    state.look_at_file();
    state.take_done();
    // Twice where a new document cannot be drawn, and the last good one is wished for instead.
    for (int attempt = 0; attempt < 2; ++attempt) {
        Wish wish{state.latest, width, height, scale, state.value_changes};
        if (wish == state.drawn || wish == state.failed) break;
        if (!state.options.is_headless && state.ask(wish)) break;
        auto drawn = state.draw(wish, state.shown);
        state.take({std::move(wish), std::move(drawn)});
    }
    return state.picture;
}

const std::vector<std::string>& HudDocument::scripts() const { return state_->scripts; }

const std::string& HudDocument::error() const {
    return state_->file_error.empty() ? state_->draw_error : state_->file_error;
}

std::uint64_t HudDocument::drawings() const { return state_->drawings; }

}  // namespace darkroom
