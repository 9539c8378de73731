// SPDX-License-Identifier: MIT
// Places for what kernels keep: each kernel its own, under a type of its own, and nobody else needs to know it.
#pragma once

#include <map>
#include <memory>
#include <typeindex>
#include <vector>

#include "render/core/index.h"

namespace h2mc {

// Where a kernel finds its T in any Slots.
template <class T>
struct Slot {
  int index = 0;
};

// Hands out slots: one for each mixture of kernels.
class SlotNumbers {
 public:
  // A slot of the caller's own.
  template <class T>
  Slot<T> add() {
    return {count_++};
  }
  // The same slot for all who ask for this T: what several kernels want to know of a state is found out once.
  template <class T>
  Slot<T> shared() {
    const auto [found, added] = shared_.try_emplace(typeid(T), count_);
    count_ += added;
    return {found->second};
  }
  // One T, made from the arguments, for all kernels of the mixture that ask for it: room to work in while a proposal is
  // made, of which nothing is kept for the next.
  template <class T, class... Arguments>
  std::shared_ptr<T> workplace(const Arguments&... arguments) {
    std::shared_ptr<void>& place = workplaces_[typeid(T)];
    if (!place) place = std::make_shared<T>(arguments...);
    return std::static_pointer_cast<T>(place);
  }

 private:
  int count_ = 0;
  std::map<std::type_index, int> shared_;
  std::map<std::type_index, std::shared_ptr<void>> workplaces_;
};

// A T for each slot, made when it is first asked for.
class Slots {
 public:
  template <class T>
  struct Content {
    T value;             // means nothing before it is known
    bool known = false;  // set by whoever fills in the value
  };

  // Precondition: the slot was handed out for T by the numbers that all slots of this object come from.
  template <class T>
  Content<T>& operator[](Slot<T> slot) {
    if (slot.index >= static_cast<int>(held_.size())) held_.resize(at(slot.index) + 1);
    std::unique_ptr<Base>& place = held_[at(slot.index)];
    if (!place) place = std::make_unique<Held<T>>();
    return static_cast<Held<T>&>(*place).content;
  }

  // Of a slot that was asked for before.
  template <class T>
  const Content<T>& operator[](Slot<T> slot) const {
    return static_cast<const Held<T>&>(*held_[at(slot.index)]).content;
  }

  // No value is known any more. They keep their memory.
  void forget() {
    for (const auto& held : held_)
      if (held) held->forget();
  }

 private:
  struct Base {
    virtual ~Base() = default;
    virtual void forget() = 0;
  };
  template <class T>
  struct Held final : Base {
    // Not set to zero: of a large T, memory that is never used is never touched.
    Held() {}  // NOLINT(modernize-use-equals-default)
    Content<T> content;
    void forget() override { content.known = false; }
  };
  std::vector<std::unique_ptr<Base>> held_;
};

}  // namespace h2mc
