// SPDX-License-Identifier: MIT
#pragma once
// What is wrong with a scene, collected with its places while the reading goes on, so that one run lists it all. Texts
// are made only for what may be shown: a hostile file has millions of faults.

#include <compare>
#include <cstdint>
#include <darkroom/result.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace darkroom::scene::reading {

/// A place in one of the files that a scene is made of; file 0 is the scene itself, others hold prefabs.
struct Place {
    std::uint32_t file = 0, line = 0, column = 0;
    friend auto operator<=>(const Place&, const Place&) = default;
};

class Report {
  public:
    explicit Report(bool is_strict) : is_strict_(is_strict) {}

    std::uint32_t add_file(std::string shown_name);
    [[nodiscard]] bool is_strict() const { return is_strict_; }
    /// "file:line:column"
    [[nodiscard]] std::string show(Place place) const;

    /// `text` is a function that makes the text. An error ends the reading, once everything has been looked at.
    template <class Text>
    void error(Place place, Text&& text) {
        add(errors_, place, std::forward<Text>(text));
    }
    /// A warning, or an error if the reading is strict.
    template <class Text>
    void slip(Place place, Text&& text) {
        add(is_strict_ ? errors_ : warnings_, place, std::forward<Text>(text));
    }
    /// ", did you mean 'x'?" or nothing; nothing either after many, since looking for names is slow.
    [[nodiscard]] std::string suggestion(std::string_view wrong, std::span<const std::string> names);

    /// The warnings in the order of the files go to the list, the errors become one line.
    [[nodiscard]] Result<> finish(std::vector<std::string>* warnings);

  private:
    struct Problem {
        Place place;
        std::string text;
    };
    struct Problems {
        std::vector<Problem> kept;
        std::size_t count = 0;
    };
    static constexpr std::size_t max_kept = 1000, max_shown = 20, max_suggestions = 64;

    template <class Text>
    void add(Problems& problems, Place place, Text&& text) {
        ++problems.count;
        if (problems.kept.size() < max_kept) problems.kept.push_back({place, text()});
    }
    [[nodiscard]] std::vector<std::string> lines(Problems& problems) const;

    bool is_strict_;
    std::vector<std::string> shown_names_;
    Problems errors_, warnings_;
    std::size_t suggestions_ = 0;
};

}  // namespace darkroom::scene::reading
