// SPDX-FileCopyrightText: 2026 The doorforge authors
// SPDX-License-Identifier: Apache-2.0
#include "datasets/mapping_guard.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <mutex>

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

namespace doorforge::internal {

// A guarded range. The handler reads it while other threads take and leave other slots, so every
// field is atomic; `begin` is written last when a range comes and first when it goes.
struct GuardedSlot {
  std::atomic<std::uintptr_t> begin{0};  // 0: nobody's
  std::atomic<std::uintptr_t> end{0};
  std::atomic<bool> damaged{false};
};

namespace {

static_assert(std::atomic<std::uintptr_t>::is_always_lock_free &&
                  std::atomic<bool>::is_always_lock_free,
              "a handler of signals may not wait for a lock");

// Slots in pieces that are never given back: the handler may walk them at any moment.
struct SlotPiece {
  std::array<GuardedSlot, 64> slots;
  std::atomic<SlotPiece*> next{nullptr};
};

constinit SlotPiece first_piece;
std::mutex taking;  // of slots; never held by the handler
struct sigaction handler_before {};

GuardedSlot* SlotAt(std::uintptr_t address) {
  for (SlotPiece* piece = &first_piece; piece != nullptr;
       piece = piece->next.load(std::memory_order_acquire)) {
    for (GuardedSlot& slot : piece->slots) {
      const std::uintptr_t begin = slot.begin.load(std::memory_order_acquire);
      if (begin == 0 || address < begin) continue;
      const std::uintptr_t end = slot.end.load(std::memory_order_acquire);
      if (address < end && slot.begin.load(std::memory_order_acquire) == begin) return &slot;
    }
  }
  return nullptr;
}

// What would have happened without this file.
void PassOn(int signal, siginfo_t* info, void* context) {
  if ((handler_before.sa_flags & SA_SIGINFO) != 0) {
    handler_before.sa_sigaction(signal, info, context);
  } else if (handler_before.sa_handler != SIG_DFL && handler_before.sa_handler != SIG_IGN) {
    handler_before.sa_handler(signal);
  } else {
    // delivered when the handler returns
    ::signal(signal, SIG_DFL);
    ::raise(signal);
  }
}

// Everything here may be called from a handler of signals: mmap() is a bare system call.
void OnBusError(int signal, siginfo_t* info, void* context) {
  const int error = errno;
  const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr);
  GuardedSlot* const slot = info->si_code > 0 ? SlotAt(address) : nullptr;
  if (slot != nullptr) {
    slot->damaged.store(true, std::memory_order_release);
    const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
    const std::uintptr_t from = address / page * page;
    const std::size_t size = slot->end.load(std::memory_order_acquire) - from;
    void* const zeros = ::mmap(reinterpret_cast<void*>(from), size, PROT_READ,
                               MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED | MAP_NORESERVE, -1, 0);
    if (zeros != MAP_FAILED) {
      errno = error;
      return;
    }
  }
  PassOn(signal, info, context);
  errno = error;
}

void SetHandlerOnce() {
  static const bool kSet = [] {
    struct sigaction action {};
    action.sa_sigaction = OnBusError;
    action.sa_flags = SA_SIGINFO | SA_RESTART | SA_ONSTACK;
    ::sigemptyset(&action.sa_mask);
    return ::sigaction(SIGBUS, &action, &handler_before) == 0;
  }();
  static_cast<void>(kSet);
}

GuardedSlot& FreeSlot() {
  for (SlotPiece* piece = &first_piece;;) {
    for (GuardedSlot& slot : piece->slots) {
      if (slot.begin.load(std::memory_order_relaxed) == 0) return slot;
    }
    SlotPiece* next = piece->next.load(std::memory_order_relaxed);
    if (next == nullptr) {
      next = new SlotPiece;
      piece->next.store(next, std::memory_order_release);
    }
    piece = next;
  }
}

}  // namespace

MappingGuard::MappingGuard(const void* begin, std::size_t size) {
  SetHandlerOnce();
  const std::lock_guard lock(taking);
  slot_ = &FreeSlot();
  slot_->damaged.store(false, std::memory_order_relaxed);
  slot_->end.store(reinterpret_cast<std::uintptr_t>(begin) + size, std::memory_order_relaxed);
  slot_->begin.store(reinterpret_cast<std::uintptr_t>(begin), std::memory_order_release);
}

MappingGuard::~MappingGuard() {
  const std::lock_guard lock(taking);
  slot_->begin.store(0, std::memory_order_release);
}

bool MappingGuard::IsDamaged() const { return slot_->damaged.load(std::memory_order_acquire); }

}  // namespace doorforge::internal
