// SPDX-License-Identifier: MIT
#pragma once
// A web page for whoever reviews pictures: one file that needs no other, with the pairs that differ from the worst on.
// It holds the pictures of a few, however many it is shown, and the numbers of all.

#include <array>
#include <compare>
#include <cstdint>
#include <darkroom/result.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compare_files.hpp"
#include "compare_report.hpp"

namespace app {

class ComparePage {
  public:
    static constexpr std::size_t max_pairs = 24;                ///< that have pictures
    static constexpr std::size_t max_bytes = 64 * 1024 * 1024;  ///< of all pictures on the page
    /// Texels of a picture's longer side. Four pictures of this size fit in max_bytes, whatever they show.
    static constexpr std::uint32_t max_side = 1920;
    static constexpr std::size_t max_rows = 4000;  ///< of the table, and lines of each list

    /// Takes the pictures of a pair if it differs and is among the worst: first by samples that are not finite in one
    /// picture alone, then by mean FLIP, then by the largest error. `index`: its place in the set that html() is given.
    [[nodiscard]] darkroom::Result<> add(std::size_t index, const ComparedFiles& files, const ComparedColor& color);

    /// The whole page: the same bytes for the same files.
    [[nodiscard]] std::string html(const ComparedSet& set, const std::string& reference, const std::string& test) const;
    [[nodiscard]] std::size_t pairs_with_pictures() const { return pairs_.size(); }

  private:
    struct Badness {
        std::uint64_t non_finite = 0;
        double flip = 0, max_error = 0;
        friend std::partial_ordering operator<=>(const Badness&, const Badness&) = default;
    };
    struct Pair {
        std::size_t index = 0;
        Badness badness;
        std::uint32_t width = 0, height = 0;              ///< of the files
        std::uint32_t shown_width = 0, shown_height = 0;  ///< on the page
        std::uint32_t gain = 1;                           ///< of the difference
        bool is_linear = false;
        std::array<std::string, 4> uris;  ///< before, after, difference, FLIP
        [[nodiscard]] std::size_t bytes() const;
    };
    [[nodiscard]] static Badness badness_of(const ComparedFiles& files);
    [[nodiscard]] std::string section(const Pair& pair, const ComparedFiles& files) const;
    [[nodiscard]] std::string table(const ComparedSet& set) const;
    void drop_last();

    std::vector<Pair> pairs_;         // worst first
    std::optional<Badness> dropped_;  // the worst of those that had no room
};

/// Can a page be written here? Told before any work is done.
[[nodiscard]] darkroom::Result<> check_page_name(const std::filesystem::path& path);

}  // namespace app
