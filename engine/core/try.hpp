// SPDX-License-Identifier: MIT
#pragma once
// Passes an error on to the caller. In a function that returns a Result,
//     DARKROOM_TRY(check(look));
//     DARKROOM_TRY_VALUE(const Look look, read_look(file));
// return what failed, or go on: the first drops a value, the second declares it, or assigns it to what there is. Not
// for an error that the caller has something to add to. An expression may hold no TRY of its own on the same line.

#include <darkroom/result.hpp>
#include <utility>

#define DARKROOM_JOINED_(a, b) a##b
#define DARKROOM_JOINED(a, b) DARKROOM_JOINED_(a, b)

#define DARKROOM_TRY(...)                                                                             \
    do {                                                                                              \
        if (auto DARKROOM_JOINED(tried_, __LINE__) = __VA_ARGS__; !DARKROOM_JOINED(tried_, __LINE__)) \
            return ::darkroom::failure(std::move(DARKROOM_JOINED(tried_, __LINE__)));                 \
    } while (false)

#define DARKROOM_TRY_VALUE(declaration, ...)                                                                          \
    auto DARKROOM_JOINED(tried_, __LINE__) = __VA_ARGS__;                                                             \
    if (!DARKROOM_JOINED(tried_, __LINE__)) return ::darkroom::failure(std::move(DARKROOM_JOINED(tried_, __LINE__))); \
    declaration = *std::move(DARKROOM_JOINED(tried_, __LINE__))
