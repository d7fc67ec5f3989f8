// SPDX-License-Identifier: MIT
#pragma once
// The words of darkroom.h, one after another. What stands between #if and #endif is for compilers alone and is passed
// over, but for the header's own guard.

#include <darkroom/result.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace app {

struct CToken {
    enum class Kind {
        Name,
        Number,
        Sign,       ///< one of {}()[];,*=
        Define,     ///< what a #define calls; its number is next
        Doc,        ///< "/// text"
        DocBehind,  ///< "///< text"
        End
    };
    Kind kind = Kind::End;
    std::string text;
    std::size_t line = 0;  ///< from 1
};

/// The last one is End. Errors as those of parse_c_header.
[[nodiscard]] darkroom::Result<std::vector<CToken>> c_tokens(std::string_view text, std::string_view shown);

/// "shown:line: what stands there: fault".
[[nodiscard]] darkroom::Failure c_error(std::string_view text, std::string_view shown, std::size_t line,
                                        std::string_view fault);

}  // namespace app
