// SPDX-License-Identifier: MIT
#pragma once
// A Composer's stack in another Composer, kept like it: entries, wires, tables and pictures, and the values of a
// moment. What layers, pulses and overrides make of a value is copied, not they themselves.

#include <darkroom/composer.hpp>
#include <map>
#include <set>
#include <span>
#include <vector>

namespace darkroom {

class StackCopy {
  public:
    struct Pair {
        Handle source, copy;
    };

    /// Makes `copy`, which nobody else edits, hold the entries of `source`. True: they changed, and it needs a compile;
    /// so it does when an opacity moves at this time and from this camera that did not before.
    [[nodiscard]] Result<bool> follow(const Composer& source, Composer& copy, double time, const Camera& camera);
    /// Switches, opacities and parameters as `source` has them at this time and from this camera. Entries that were
    /// edited since follow() stay as they are.
    [[nodiscard]] Result<> follow_values(const Composer& source, Composer& copy, double time,
                                         const Camera& camera) const;
    /// In the order of the stack.
    [[nodiscard]] std::span<const Pair> entries() const { return entries_; }

  private:
    /// What a compile depends on.
    struct Shape {
        std::uint32_t id = 0;
        const EffectInfo* info = nullptr;
        EntryDesc desc;
        std::vector<std::uint32_t> words;  ///< of rows that are read at compile, and of tables and pictures
        bool is_mixable = false;           ///< its opacity is, or was once, between 0 and 1
    };
    [[nodiscard]] Shape shape_of(const Composer& source, Handle entry, double time, const Camera& camera);
    [[nodiscard]] static bool is_same(const Shape& a, const Shape& b);
    [[nodiscard]] Result<> define_resources(const Composer& source, Composer& copy);
    [[nodiscard]] Handle copy_of(Handle wire) const;
    [[nodiscard]] std::vector<std::uint32_t> copied_words(const EffectInfo& info,
                                                          std::span<const std::uint32_t> words) const;

    bool is_made_ = false;
    std::vector<Shape> shapes_;
    std::vector<Pair> entries_;
    std::map<std::uint32_t, Resource> resources_;  ///< by the source's number
    std::set<std::uint32_t> mixed_;                ///< entries whose opacity was between 0 and 1
};

}  // namespace darkroom
