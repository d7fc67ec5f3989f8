// SPDX-License-Identifier: MIT
#pragma once
// How recording hands things to the worker, and back, without a lock, a wait or memory: lists that link themselves.

#include <atomic>

namespace darkroom::compose {

/// Any thread pushes; one thread at a time takes everything, last pushed first. T has a member `T* next`, and is in one
/// list at a time. Owns nothing.
template <class T>
class AtomicStack {
  public:
    void push(T& item) {
        item.next = head_.load(std::memory_order_relaxed);
        while (!head_.compare_exchange_weak(item.next, &item, std::memory_order_release, std::memory_order_relaxed)) {
        }
    }
    [[nodiscard]] T* take_all() { return head_.exchange(nullptr, std::memory_order_acquire); }
    [[nodiscard]] bool is_empty() const { return head_.load(std::memory_order_relaxed) == nullptr; }

  private:
    std::atomic<T*> head_{nullptr};
};

/// What a recording took out of use: the worker, or the next compile, frees it.
struct Garbage {
    Garbage() = default;
    Garbage(const Garbage&) = delete;
    Garbage& operator=(const Garbage&) = delete;
    virtual ~Garbage() = default;
    Garbage* next = nullptr;
};
/// Frees a list that was taken.
inline void free_garbage(Garbage* list) {
    while (list != nullptr) {
        Garbage* const after = list->next;
        delete list;
        list = after;
    }
}

}  // namespace darkroom::compose
