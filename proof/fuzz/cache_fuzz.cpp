// SPDX-License-Identifier: MIT
// Entries of the cache of kernels, as another process, a full disk or a
// stranger may have left them: one whose hash fits is what it holds, any other
// is made anew, and the next reader finds it mended.

#include <fmt/format.h>

#include <cstring>

#include "core/files.hpp"
#include "core/hash.hpp"
#include "fuzz/target.hpp"
#include "gpu/shader/shader.hpp"

namespace darkroom::fuzz::cache_fuzz {
namespace {

using namespace gpu;
using Words = std::vector<std::uint32_t>;

/// A cache of one kernel, in memory where there is a file system for it.
class Cache {
  public:
    Cache() {
        std::string name = (std::filesystem::exists("/dev/shm") ? "/dev/shm" : "/tmp") + std::string("/cache_XXXXXX");
        if (mkdtemp(name.data()) == nullptr) std::abort();
        folder_ = name;
        made_ = ShaderCompiler(folder_).compile(source_).value();
        entry_ = std::filesystem::directory_iterator(folder_)->path();
        whole_ = read_file(entry_).value();
    }
    Cache(const Cache&) = delete;
    Cache& operator=(const Cache&) = delete;
    ~Cache() { std::filesystem::remove_all(folder_); }

    [[nodiscard]] std::string_view whole() const {
        return {reinterpret_cast<const char*>(whole_.data()), whole_.size()};
    }
    /// What stands before an entry's words: their hash under its name.
    [[nodiscard]] Hash hash_of(std::string_view words) const {
        return content_hash(entry_.stem().string().append(words));
    }
    [[nodiscard]] std::string wrong_entry(std::string_view bytes) const {
        if (!write_file(entry_, bytes_of(bytes))) return "the entry cannot be written";
        const bool fits = bytes.size() > sizeof(Hash) && bytes.size() % sizeof(std::uint32_t) == 0 && hash_fits(bytes);
        ShaderCompiler compiler(folder_);
        const Result<Words> words = compiler.compile(source_);
        if (!words) return "there is an error: " + words.error().text;
        if (compiler.from_cache != (fits ? 1U : 0U)) return fits ? "a whole entry is not read" : "an entry is trusted";
        if (!fits) return *words == made_ && read_file(entry_) == whole_ ? std::string() : "an entry is not mended";
        const std::string_view content = bytes.substr(sizeof(Hash));
        const bool same = words->size() * sizeof(std::uint32_t) == content.size() &&
                          std::memcmp(words->data(), content.data(), content.size()) == 0;
        return same ? std::string() : "an entry gives other words than it holds";
    }

  private:
    [[nodiscard]] bool hash_fits(std::string_view bytes) const {
        Hash hash;
        std::memcpy(&hash, bytes.data(), sizeof hash);
        return hash == hash_of(bytes.substr(sizeof hash));
    }

    ShaderSource source_{.name = "test", .text = "#version 460\nlayout(local_size_x = 1) in;\nvoid main() {}\n"};
    std::filesystem::path folder_, entry_;
    Words made_;
    std::vector<std::byte> whole_;
};

const Cache& cache() {
    static const Cache one;
    return one;
}

std::string run(std::string_view input) {
    if (std::string wrong = cache().wrong_entry(input); !wrong.empty()) return wrong;
    if (input.size() < sizeof(Hash)) return {};
    // No fuzzer finds a hash.
    std::string mended(input);
    const Hash hash = cache().hash_of(input.substr(sizeof(Hash)));
    std::memcpy(mended.data(), &hash, sizeof hash);
    return cache().wrong_entry(mended);
}

std::vector<std::string> seeds() { return {std::string(cache().whole())}; }

const Registration entries({.name = "cache", .run = run, .seeds = seeds, .max_mebibytes = 16});

}  // namespace
}  // namespace darkroom::fuzz::cache_fuzz
