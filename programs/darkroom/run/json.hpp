// SPDX-License-Identifier: MIT
#pragma once
// What the commands' --json documents and the records of farms are made of. The door to nlohmann's library, which reads
// and writes them: its headers take seconds to compile, so only json.cpp includes them.

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace app {

/// A value of JSON. Objects keep their order. A list in braces is an object where all in it are pairs that begin with a
/// text, and an array otherwise: Json{{"size", {640, 360}}, {"name", "a"}}.
class Json {
  public:
    struct Member;

    Json();
    Json(std::nullptr_t) : Json() {}
    Json(std::initializer_list<Json> list);
    Json(std::same_as<bool> auto value) : Json() { set(bool{value}); }
    template <std::integral T>
    requires(!std::same_as<T, bool>) Json(T value) : Json() { set(static_cast<std::int64_t>(value)); }
    Json(std::floating_point auto value) : Json() { set(double{value}); }
    Json(std::string text);
    Json(std::string_view text) : Json(std::string(text)) {}
    Json(const char* text) : Json(std::string(text)) {}
    template <std::ranges::input_range T>
    requires(!std::convertible_to<T, std::string_view> && !std::same_as<std::ranges::range_value_t<T>, T> &&
             std::convertible_to<std::ranges::range_reference_t<T>, Json>) Json(const T& list)
        : Json(array()) {
        for (const auto& item : list) push_back(item);
    }
    Json(const Json& other);
    Json(Json&& other) noexcept;
    Json& operator=(const Json& other);
    Json& operator=(Json&& other) noexcept;
    ~Json();

    [[nodiscard]] static Json array();
    [[nodiscard]] static Json object();
    /// Nothing where it is not JSON, or nests deeper than 64 times.
    [[nodiscard]] static std::optional<Json> parse(std::string_view text);
    /// What is no JSON becomes a text.
    [[nodiscard]] static Json value_or_text(std::string_view text);

    [[nodiscard]] bool is_null() const;
    [[nodiscard]] bool is_boolean() const;
    [[nodiscard]] bool is_whole() const;
    [[nodiscard]] bool is_number() const;
    [[nodiscard]] bool is_text() const;
    [[nodiscard]] bool is_array() const;
    [[nodiscard]] bool is_object() const;

    // Of one that is_...
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] std::int64_t whole() const;
    [[nodiscard]] double number() const;
    [[nodiscard]] const std::string& text() const;
    [[nodiscard]] const std::vector<Json>& elements() const;
    [[nodiscard]] const std::vector<Member>& members() const;

    /// Of elements or members; a null has none.
    [[nodiscard]] std::size_t size() const;
    [[nodiscard]] bool empty() const { return size() == 0; }
    /// Of an object; nullptr: there is none.
    [[nodiscard]] const Json* find(std::string_view key) const;

    /// Of an object, or of a null, which becomes one.
    Json& operator[](std::string_view key);
    /// Of an array, or of a null, which becomes one.
    void push_back(Json value);
    /// Takes the members of another object; those of the same key are replaced.
    void update(const Json& other);

    /// Of `indent` spaces a level; without them in one line. Text that is no UTF-8 is written with a sign in its place.
    [[nodiscard]] std::string dump(std::optional<int> indent = {}) const;

  private:
    // Not here, where a member is no whole type yet.
    void set(bool value);
    void set(std::int64_t value);
    void set(double value);

    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<Json>, std::vector<Member>>
        value_;
};

struct Json::Member {
    std::string key;
    Json value;
};

/// JSON has no infinity and no NaN: "inf", "-inf", "nan".
[[nodiscard]] Json json_number(double value);

}  // namespace app
