#pragma once
/// \file
/// Room on the stack for jets of packs in many variables.

#include <gtest/gtest.h>
#include <pthread.h>

#include <cstddef>

namespace karcher::testing {

/// Runs work with a stack of half a gigabyte: jets of packs in 18 variables take 12 kB each, and sanitizers give every temporary a place of its own.
template <class Work>
void with_large_stack(Work work) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, std::size_t{1} << 29);
  pthread_t thread;
  const auto start = [](void* w) -> void* {
    (*static_cast<Work*>(w))();
    return nullptr;
  };
  ASSERT_EQ(pthread_create(&thread, &attributes, start, &work), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
}

}  // namespace karcher::testing
