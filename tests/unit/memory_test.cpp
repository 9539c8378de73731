// SPDX-License-Identifier: MIT
#include "render/core/memory.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene_files.h"

namespace h2mc {
namespace {

using testing::SceneFolder;

// The value of what `call` throws.
template <class Call>
std::string messageOf(Call call) {
  try {
    call();
  } catch (const MemoryError& e) {
    return e.what();
  }
  return "";
}

TEST(Memory, NoGroupsNoLimit) {
  const SceneFolder folder;
  EXPECT_TRUE(std::isinf(memoryLeftInGroups(folder.path())));
  folder.write("proc/self/cgroup", "0::/a/b\n");
  folder.write("sys/fs/cgroup/a/b/memory.max", "max\n");
  folder.write("sys/fs/cgroup/a/b/memory.current", "5\n");
  EXPECT_TRUE(std::isinf(memoryLeftInGroups(folder.path())));
}

TEST(Memory, TheGroupAndThoseAboveIt) {
  const SceneFolder folder;
  folder.write("proc/self/cgroup", "0::/a/b\n");
  folder.write("sys/fs/cgroup/a/b/memory.max", "1000\n");
  folder.write("sys/fs/cgroup/a/b/memory.current", "300\n");
  EXPECT_EQ(memoryLeftInGroups(folder.path()), 700);
  folder.write("sys/fs/cgroup/a/b/memory.stat", "anon 200\ninactive_file 50\nactive_file 9\n");
  EXPECT_EQ(memoryLeftInGroups(folder.path()), 750);
  folder.write("sys/fs/cgroup/a/memory.max", "2000\n");
  folder.write("sys/fs/cgroup/a/memory.current", "1600\n");
  EXPECT_EQ(memoryLeftInGroups(folder.path()), 400);
  folder.write("sys/fs/cgroup/memory.max", "100\n");  // a container's own
  folder.write("sys/fs/cgroup/memory.current", "130\n");
  EXPECT_EQ(memoryLeftInGroups(folder.path()), 0);
}

TEST(Memory, VersionOne) {
  const SceneFolder folder;
  folder.write("proc/self/cgroup", "3:cpu,cpuacct:/c\n4:memory:/x/y\n0::/\n");
  folder.write("sys/fs/cgroup/memory/x/y/memory.limit_in_bytes", "1000\n");
  folder.write("sys/fs/cgroup/memory/x/y/memory.usage_in_bytes", "900\n");
  folder.write("sys/fs/cgroup/memory/x/y/memory.stat", "cache 3\ntotal_inactive_file 40\n");
  EXPECT_EQ(memoryLeftInGroups(folder.path()), 140);
  // Not seen from within a container, whose own group is the root.
  folder.write("proc/self/cgroup", "4:memory:/elsewhere\n");
  EXPECT_TRUE(std::isinf(memoryLeftInGroups(folder.path())));
  folder.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "500\n");
  folder.write("sys/fs/cgroup/memory/memory.usage_in_bytes", "100\n");
  EXPECT_EQ(memoryLeftInGroups(folder.path()), 400);
}

TEST(Memory, WhatIsNotThereIsRefused) {
  EXPECT_GT(memoryLeft().bytes, 1e6);
  EXPECT_EQ(messageOf([] { requireMemory(1, "it", "expected less"); }), "");
  const std::string message = messageOf([] { requireMemory(1e18, "it", "expected less"); });
  EXPECT_NE(message.find("it needs 1 EB of memory"), std::string::npos) << message;
  EXPECT_NE(message.find("expected less, or --max-memory"), std::string::npos) << message;
}

TEST(Memory, AnOptionSetsTheLimit) {
  setMostMemory(1e15);
  EXPECT_GT(memoryLeft().bytes, 0.99e15);
  EXPECT_EQ(memoryLeft().source, "--max-memory");
  EXPECT_EQ(messageOf([] { requireMemory(0.9e15, "it", "expected less"); }), "");
  setMostMemory(1);
  EXPECT_EQ(memoryLeft().bytes, 0);
  EXPECT_NE(messageOf([] { requireMemory(1, "it", "expected less"); }), "");
  setMostMemory(0);
}

}  // namespace
}  // namespace h2mc
