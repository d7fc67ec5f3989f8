// SPDX-License-Identifier: MIT
#pragma once
// What happens to a look while a sequence is made, from a file of events (docs/looks.md): values are set, pulses fired,
// layers blended in, at moments of the sequence's time.

#include <darkroom/look.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace app {

/// What an event says of the game.
struct GameEvent {
    double time = 0;
    darkroom::GameTable values;
    bool is_jump = false;
    bool is_teleport = false;   ///< the view is elsewhere at once, at rest: `yaw` pushes nothing
    std::optional<double> yaw;  ///< degrees: where the view looks from then on
};

class Timeline {
  public:
    /// Nothing ever happens.
    Timeline() = default;
    /// For this look. Errors are file:line:column: what an event names and the look has not, a value out of range.
    [[nodiscard]] static darkroom::Result<Timeline> read(const std::filesystem::path& path, darkroom::Look& look);

    /// Entries that events set, which must be there even where the look has them off.
    [[nodiscard]] const std::vector<std::string>& entries() const { return entries_; }
    /// When events happen, in order.
    [[nodiscard]] std::vector<double> times() const;
    /// What is said of the game, in order.
    [[nodiscard]] std::vector<GameEvent> game() const;
    /// The look is another now: what events have not set is as this one has it.
    void follow(const darkroom::Look& look);
    /// Brings a Composer that holds the look to what is the case at `time`: the same whatever was advanced to, or set
    /// in the Composer, before. Values are overrides named "timeline". What the Composer lacks is passed over.
    [[nodiscard]] darkroom::Result<> advance(darkroom::Composer& composer, double time);

  private:
    friend class TimelineReader;
    /// Of one event: an entry's value; or its own `enabled` or `opacity`.
    struct Value {
        std::string entry, parameter;
        std::vector<std::uint32_t> words;
        bool is_state = false;
    };
    struct Weight {
        std::string layer;
        float weight = 0;
    };
    struct Event {
        double time = 0;
        double over = 0;  ///< seconds in which weights get there
        std::vector<Value> values;
        std::vector<std::string> fired;
        std::vector<Weight> weights;
        GameEvent game{};
    };
    /// A layer's way from one weight to another.
    struct Way {
        std::string layer;
        float first = 0;  ///< before all events
        double start = 0, over = 0;
        double from = 0, to = 0;
        [[nodiscard]] double at(double time) const;
    };

    void restart(darkroom::Composer& composer);
    void take(const Event& event);
    [[nodiscard]] static darkroom::Result<> apply(darkroom::Composer& composer, const Value& value);

    std::vector<Event> events_;  ///< by time
    std::vector<std::string> entries_;
    std::vector<Way> ways_;
    std::vector<Value> states_;  ///< of entries whose `enabled` or `opacity` is set, as the look has them
    std::vector<Value> now_;     ///< those, and what events have set so far
    bool is_other_look_ = false;
    std::size_t next_ = 0;
    double last_time_ = 0;
};

}  // namespace app
