// SPDX-License-Identifier: MIT
// Keyframed transforms and what they are cut into.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "render/camera/camera.h"
#include "render/core/motion.h"
#include "render/core/random.h"

namespace h2mc {
namespace {

glm::dmat4 rotation(double degrees, const glm::dvec3& axis) {
  return glm::rotate(glm::dmat4(1), glm::radians(degrees), glm::normalize(axis));
}
glm::dmat4 translation(double x, double y, double z) {
  return glm::translate(glm::dmat4(1), glm::dvec3(x, y, z));
}
glm::dmat4 shear() {
  glm::dmat4 m(1);
  m[1][0] = 0.7;
  m[2][1] = -0.4;
  return m;
}

void expectSame(const glm::dmat4& a, const glm::dmat4& b, double tolerance) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(a[i][j], b[i][j], tolerance) << i << " " << j;
}

TEST(Decomposition, GivesBackTheMatrix) {
  Random random(1, 0, 0);
  for (int k = 0; k < 200; ++k) {
    glm::dmat4 m(1);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m[i][j] = 2 * random.uniformDouble() - 1;
    m[3] = glm::dvec4(random.uniformDouble(), 5, -3, 1);
    const double determinant = glm::determinant(glm::dmat3(m));
    if (std::abs(determinant) < 1e-3) continue;
    const Decomposition d = Decomposition::of(m);
    expectSame(d.matrix(), m, 1e-10);
    const glm::dmat3 s = d.stretch;
    EXPECT_NEAR(s[0][1], s[1][0], 1e-12);
    EXPECT_GT(determinant * s[0][0], 0) << "positive definite, or negative where m mirrors";
    EXPECT_GT(determinant * glm::determinant(s), 0);
    EXPECT_NEAR(glm::length(d.rotation), 1, 1e-12);
  }
}

TEST(Motion, TurnsByTheAngleAndKeepsShear) {
  const glm::dmat4 base = shear();
  const Motion::Keyframe keys[] = {{0, base},
                                   {2, translation(4, 0, 2) * rotation(90, {1, 2, 3}) * base}};
  const Motion motion(keys, 0, 2);
  ASSERT_TRUE(motion.moves());
  // M = T R S with one S at both ends would need base symmetric: compare with the parts instead.
  const Decomposition a = Decomposition::of(keys[0].matrix), b = Decomposition::of(keys[1].matrix);
  expectSame(glm::dmat4(a.stretch), glm::dmat4(b.stretch), 1e-12);
  const double share = 0.3;
  const glm::dmat4 expected =
      translation(4 * share, 0, 2 * share) * rotation(90 * share, {1, 2, 3}) * base;
  expectSame(motion.at(share), expected, 1e-12);
  expectSame(motion.at(0), keys[0].matrix, 1e-12);
  expectSame(motion.at(1), keys[1].matrix, 1e-12);
}

TEST(Motion, SeesTheShutterOnly) {
  const Motion::Keyframe keys[] = {
      {1, translation(0, 0, 0)}, {2, translation(2, 0, 0)}, {4, translation(2, 6, 0)}};
  const auto x = [](const Motion& m, double moment) { return glm::dvec3(m.at(moment)[3]); };
  const auto expectAt = [&](const Motion& m, double moment, double px, double py) {
    EXPECT_NEAR(x(m, moment).x, px, 1e-12);
    EXPECT_NEAR(x(m, moment).y, py, 1e-12);
  };
  const Motion part(keys, 1.5, 3);
  ASSERT_EQ(part.keys().size(), 3u);
  expectAt(part, 0, 1, 0);
  expectAt(part, 1.0 / 3, 2, 0);
  expectAt(part, 1, 2, 3);
  const Motion before(keys, -3, 1), after(keys, 4, 9), instant(keys, 3, 3);
  EXPECT_FALSE(before.moves());
  EXPECT_FALSE(after.moves());
  EXPECT_FALSE(instant.moves());
  expectAt(before, 0.5, 0, 0);
  expectAt(after, 0.5, 2, 6);
  expectAt(instant, 0.5, 2, 3);
  const Motion beyond(keys, 0, 2);  // stands still at first
  expectAt(beyond, 0.25, 0, 0);
  expectAt(beyond, 0.75, 1, 0);
}

TEST(MotionSegments, AsFewAsTheErrorAllows) {
  const glm::dvec3 low(-1), high(1);
  double error = 1;
  const Motion::Keyframe slide[] = {{0, translation(0, 0, 0)}, {1, translation(50, 1, 2)}};
  EXPECT_EQ(motionSegments(Motion(slide, 0, 1), low, high, error), 1);
  EXPECT_LT(error, 1e-12);
  const Motion::Keyframe bend[] = {
      {0, translation(0, 0, 0)}, {0.25, translation(5, 0, 0)}, {1, translation(0, 5, 0)}};
  EXPECT_EQ(motionSegments(Motion(bend, 0, 1), low, high, error), 4);

  const Motion::Keyframe turn[] = {{0, rotation(0, {0, 0, 1})}, {1, rotation(170, {1, 0, 1})}};
  const Motion motion(turn, 0, 1);
  const int segments = motionSegments(motion, low, high, error);
  EXPECT_GT(segments, 8);
  EXPECT_LT(segments, 60);
  EXPECT_LE(error, kChordError);
  // The bound holds for points within the box at any moment.
  Random random(3, 0, 0);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec4 p(2 * random.uniformDouble() - 1, 2 * random.uniformDouble() - 1,
                       2 * random.uniformDouble() - 1, 1);
    const double moment = random.uniformDouble(), scaled = moment * segments;
    const double index = std::floor(scaled);
    const glm::dvec4 a = motion.at(index / segments) * p, b = motion.at((index + 1) / segments) * p;
    const glm::dvec4 off = a + (b - a) * (scaled - index) - motion.at(moment) * p;
    worst = std::max(worst, glm::length(off) / glm::length(high - low));
  }
  EXPECT_LE(worst, kChordError * 1.05);
  EXPECT_GT(worst, kChordError * 0.1);

  // A point far from what it turns around.
  EXPECT_GT(motionSegments(motion, {9, 9, 9}, {10, 10, 10}, error), segments);
  std::vector<Motion::Keyframe> spin;
  for (int i = 0; i <= 90; ++i)
    spin.push_back({double(i), rotation(i * 120, {0, 1, 0}) * translation(9, 0, 0)});
  EXPECT_EQ(motionSegments(Motion(spin, 0, 90), low, high, error), kMaxMotionSegments);
  EXPECT_GT(error, kChordError);
}

TEST(CameraMotion, FollowsTheTransform) {
  const glm::dmat4 mirror = glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1));
  for (const glm::dmat4& base : {glm::dmat4(1), mirror}) {
    const Motion::Keyframe keys[] = {
        {0, translation(1, 2, 3) * rotation(20, {1, 1, 0}) * base},
        {0.3, translation(0, 2, 5) * rotation(70, {0, 1, 0.2}) * base},
        {1, translation(0, 1, 4) * rotation(70.01, {0, 1, 0.2}) * base}};
    const Motion motion(keys, 0, 1);
    Camera camera(Mat4(motion.at(0)), 50, Camera::FovAxis::kX, 1.5f);
    camera.follow(motion);
    ASSERT_TRUE(camera.moves());
    for (int i = 0; i <= 50; ++i) {
      const double moment = i / 50.0;
      const CameraPose<double> pose = camera.poseAt<double>(&moment, nullptr);
      const glm::dmat4 m = motion.at(moment);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(pose.left[k], m[0][k], 1e-6);
        EXPECT_NEAR(pose.up[k], m[1][k], 1e-6);
        EXPECT_NEAR(pose.forward[k], m[2][k], 1e-6);
        EXPECT_NEAR(pose.position[k], m[3][k], 1e-6);
      }
    }
    const CameraPose<float> begin = camera.poseOf(0, {0.5f, 0.5f}), still = camera.pose<float>();
    EXPECT_LT(glm::length(begin.left - still.left), 1e-6f);
    EXPECT_LT(glm::length(begin.forward - still.forward), 1e-6f);
    EXPECT_LT(glm::length(begin.position - still.position), 1e-6f);
    // Film positions and directions are each other's inverse at every moment.
    const CameraPose<float> pose = camera.poseOf(0.6f, {0.5f, 0.5f});
    float x, y;
    ASSERT_TRUE(camera.project(pose, camera.direction(pose, 0.2f, 0.7f) * 3.f, x, y));
    EXPECT_NEAR(x, 0.2f, 1e-5f);
    EXPECT_NEAR(y, 0.7f, 1e-5f);
  }
}

}  // namespace
}  // namespace h2mc
