// SPDX-License-Identifier: MIT
// Embree and the ray's offset, against brute force in double and against what must be so.
#include <gtest/gtest.h>

#include <array>

#include "geometry_cases.h"
#include "render/geometry/ray_tracer.h"
#include "vast_ground.h"

namespace h2mc {
namespace {

using namespace test;

struct Hit {
  PrimitiveId id;
  double t = 1e300;
  double margin = 0;  // how far inside the primitive, relative to it; of the nearest primitive
};

// The nearest hit by double arithmetic, for all primitives in turn.
Hit bruteForce(std::span<const Shape> shapes, const Vec3f& from, const Vec3f& along,
               double& closestEdge) {
  const glm::dvec3 o(from), d(along);
  Hit hit;
  closestEdge = 1;
  for (unsigned s = 0; s < shapes.size(); ++s) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&shapes[s].geometry)) {
      for (unsigned i = 0; i < mesh->triangles.size(); ++i) {
        const glm::uvec3 t = mesh->triangles[i];
        const glm::dvec3 a(mesh->positions[t.x]), e1 = glm::dvec3(mesh->positions[t.y]) - a,
                                                  e2 = glm::dvec3(mesh->positions[t.z]) - a;
        const glm::dvec3 p = glm::cross(d, e2);
        const double det = glm::dot(e1, p);
        const double u = glm::dot(o - a, p) / det;
        const glm::dvec3 q = glm::cross(o - a, e1);
        const double v = glm::dot(d, q) / det, distance = glm::dot(e2, q) / det;
        const double margin = std::min({u, v, 1 - u - v});
        if (distance > 0) closestEdge = std::min(closestEdge, std::abs(margin));
        if (margin >= 0 && distance > 0 && distance < hit.t) hit = {{s, i}, distance, margin};
      }
    } else if (const auto* ball = std::get_if<Sphere>(&shapes[s].geometry)) {
      const glm::dvec3 c = glm::dvec3(ball->center) - o;
      const double b = glm::dot(c, d), r = static_cast<double>(ball->radius);
      const double disc = r * r - glm::dot(c - d * b, c - d * b);
      closestEdge = std::min(closestEdge, std::abs(disc) / (r * r));
      if (disc < 0) continue;
      for (unsigned root = 0; root < 2; ++root) {
        const double t = b + (root ? 1 : -1) * std::sqrt(disc);
        if (t > 0 && t < hit.t) hit = {{s, root}, t, disc};
      }
    } else {
      const auto& disk = std::get<Disk>(shapes[s].geometry);
      const glm::dvec3 ax(disk.axisX), ay(disk.axisY), n = glm::cross(ax, ay);
      const double t = glm::dot(glm::dvec3(disk.center) - o, n) / glm::dot(d, n);
      const glm::dvec3 p = o + d * t - glm::dvec3(disk.center);
      const double x = glm::dot(p, glm::cross(ay, n)) / glm::dot(n, n),
                   y = glm::dot(p, glm::cross(n, ax)) / glm::dot(n, n);
      if (t > 0) closestEdge = std::min(closestEdge, std::abs(1 - x * x - y * y));
      if (t > 0 && x * x + y * y <= 1 && t < hit.t) hit = {{s, 0}, t, 1 - x * x - y * y};
    }
  }
  return hit;
}

std::vector<Shape> mixedScene(float scale, const Vec3f& by) {
  std::vector<Shape> shapes{
      soup(150, 0.3f, 7), sphere(Vec3f(0.3f, 0.2f, -0.4f), 0.35f),
      sphere(Vec3f(-0.5f, 0.6f, 0.5f), 0.2f),
      disk(Vec3f(0, -0.3f, 0.1f), Vec3f(0.4f, 0.1f, 0), Vec3f(-0.2f, 0.3f, 0.3f)),
      soup(50, 0.05f, 8)};
  for (Shape& s : shapes) s = moved(std::move(s), tilt(), scale, by * scale);
  return shapes;
}

class Scales : public testing::TestWithParam<float> {};
INSTANTIATE_TEST_SUITE_P(Scales, Scales, testing::Values(1e-4f, 1.f, 1e3f, 1e6f));

TEST_P(Scales, FindsTheNearestPrimitive) {
  const float scale = GetParam();
  const std::vector<Shape> shapes = mixedScene(scale, Vec3f(0.5f, 0, 2));
  const RayTracer tracer(shapes);
  Random random(1, 2, 3);
  int hits = 0, disagreements = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f origin = (randomPoint(random) * 1.5f + Vec3f(0.5f, 0, 2)) * scale;
    const Vec3f direction = randomDirection(random);
    double edge;
    const Hit expected = bruteForce(shapes, origin, direction, edge);
    const PrimitiveId id = tracer.intersect({origin}, direction);
    hits += expected.id.valid();
    if (id == expected.id) {
      if (!id.valid()) continue;
      const SurfacePoint<float> p = intersectPrimitive<float>(shapes, id, origin, direction);
      // The recomputed point against the line's in double: within some ulps of the coordinates,
      // times the stretching at a grazing angle.
      const glm::dvec3 along = glm::dvec3(origin) + glm::dvec3(direction) * expected.t;
      const double cosine = std::abs(static_cast<double>(dot(p.ng, direction)));
      ASSERT_LT(glm::length(glm::dvec3(p.p) - along), 2e-6 * static_cast<double>(scale) / cosine);
      ASSERT_FALSE(tracer.escapes({origin}, direction));
    } else if (edge > 1e-4) {
      ++disagreements;
    }
  }
  EXPECT_GT(hits, 3000);
  EXPECT_EQ(disagreements, 0);
}

TEST_P(Scales, RespectsDistances) {
  const float scale = GetParam();
  const std::vector<Shape> shapes{sphere(Vec3f(0, 0, 5 * scale), scale)};
  const RayTracer tracer(shapes);
  const RayEnd o;
  const Vec3f z(0, 0, 1);
  EXPECT_EQ(tracer.intersect(o, z).primitive, 0u);
  EXPECT_EQ(tracer.intersect(o, z, 4.5f * scale).primitive, 1u);
  EXPECT_TRUE(tracer.intersect(o, z, 4.5f * scale).valid());
  EXPECT_FALSE(tracer.intersect(o, z, 6.5f * scale).valid());
  EXPECT_FALSE(tracer.intersect(o, z, 0, 3.5f * scale).valid());
  EXPECT_TRUE(tracer.visible(o, {z * (3.9f * scale)}));
  EXPECT_FALSE(tracer.visible(o, {z * (4.1f * scale)}));
}

// Convex bodies: a ray that leaves the surface outwards meets nothing, one that goes inwards meets
// another part of the surface, and from inside every point sees every other.
struct Convex {
  const char* name;
  Shape shape;
};

std::vector<Convex> convexBodies() {
  return {{"cube", cube()},
          {"ball", ball(8, false)},
          {"fine ball", ball(60, true)},
          {"sphere", sphere(Vec3f(0), 1)}};
}

struct Case {
  float scale;
  Vec3f by;  // in units of the scale
};
const std::array kCases{Case{1, Vec3f(0)},          Case{1e-4f, Vec3f(0)},
                        Case{1e6f, Vec3f(0)},       Case{1, Vec3f(1, 0.5f, -0.7f)},
                        Case{1, Vec3f(30, -20, 9)}, Case{1e-4f, Vec3f(3, 9, 1)},
                        Case{1e6f, Vec3f(-3, 5, 1)}};

Vec3f outward(const Vec3f& ng, const Vec3f& p, const Vec3f& center) {
  return dot(ng, p - center) < 0 ? -ng : ng;
}

TEST(RayTracer, LeavesConvexBodies) {
  for (const Convex& body : convexBodies())
    for (const Case& c : kCases) {
      const Vec3f center = c.by * c.scale;
      const std::vector<Shape> shapes{moved(body.shape, tilt(), c.scale, center)};
      const RayTracer tracer(shapes);
      Random random(4, 5, 6);
      int selfHits = 0, leaks = 0, total = 0;
      for (int i = 0; i < 20000; ++i) {
        // A point as paths find it: by a ray from outside.
        const Vec3f target = center + randomPoint(random) * (0.5f * c.scale);
        const Vec3f direction = randomDirection(random);
        const Vec3f origin = target - direction * (5 * c.scale);
        const PrimitiveId id = tracer.intersect({origin}, direction);
        if (!id.valid()) continue;
        const SurfacePoint<float> p = intersectPrimitive<float>(shapes, id, origin, direction);
        const Vec3f n = outward(p.ng, p.p, center);
        Vec3f next = randomDirection(random);
        if (std::abs(dot(next, n)) < 1e-3f) continue;
        ++total;
        if (dot(next, n) < 0) next = -next;
        selfHits += !tracer.escapes(p.end(), next);
        const PrimitiveId inside = tracer.intersect(p.end(), -next);
        leaks += !inside.valid();
        const bool curved = std::holds_alternative<Sphere>(shapes[0].geometry);
        selfHits += inside.valid() && (curved ? inside.primitive != 1 : inside == id);
      }
      EXPECT_GT(total, 10000);
      EXPECT_EQ(selfHits, 0) << body.name << " scale " << c.scale << " at " << c.by.x;
      // Past an edge, by the offset.
      EXPECT_LE(leaks, 2) << body.name << " scale " << c.scale << " at " << c.by.x;
    }
}

TEST(RayTracer, SeesAcrossConvexRoomsAndNotThroughWalls) {
  for (const Convex& body : convexBodies())
    for (const Case& c : kCases) {
      const Vec3f center = c.by * c.scale;
      const std::vector<Shape> shapes{moved(body.shape, tilt(), c.scale, center)};
      const RayTracer tracer(shapes);
      const bool mesh = std::holds_alternative<TriangleMesh>(shapes[0].geometry);
      const auto primitives = static_cast<unsigned>(
          mesh ? std::get<TriangleMesh>(shapes[0].geometry).triangles.size() : 1);
      Random random(8, 5, 6);
      int hidden = 0, through = 0;
      for (int i = 0; i < 20000; ++i) {
        const auto point = [&] {
          const PrimitiveId id{0, random.next() % primitives};
          const float u0 = random.uniform(), u1 = random.uniform();
          return samplePrimitive<float>(shapes, id, u0, u1);
        };
        const SurfacePoint<float> a = point(), b = point();
        const float distance = glm::distance(a.p, b.p);
        const Vec3f w = (b.p - a.p) / distance;
        if (std::min(std::abs(dot(a.ng, w)), std::abs(dot(b.ng, w))) < 0.02f) continue;
        hidden += !tracer.visible(a.end(), b.end());
        // A little beyond the wall.
        const Vec3f n = outward(b.ng, b.p, center);
        through += tracer.visible(a.end(), {b.p + n * (1e-3f * distance + 1e-4f * c.scale)});
      }
      EXPECT_EQ(hidden, 0) << body.name << " scale " << c.scale << " at " << c.by.x;
      EXPECT_LE(through, 2) << body.name << " scale " << c.scale << " at " << c.by.x;
    }
}

// Between two points of one plane nothing is seen, whichever of them rounding puts on top, nor is a lamp's point in the
// plane of what it lights.
TEST(RayTracer, SeesNothingAlongAPlane) {
  for (const Case& c : kCases) {
    const std::vector<Shape> shapes{
        moved(parallelogram(Vec3f(-1, -1, 0), Vec3f(2, 0, 0), Vec3f(0, 2, 0)), tilt(), c.scale,
              c.by * c.scale)};
    const RayTracer tracer(shapes);
    Random random(4, 5, 6);
    int seen = 0, toBare = 0;
    for (int i = 0; i < 20000; ++i) {
      const auto point = [&] {
        const float u0 = random.uniform(), u1 = random.uniform();
        return samplePrimitive<float>(shapes, {0, random.next() % 2}, u0, u1);
      };
      const SurfacePoint<float> a = point(), b = point();
      seen += tracer.visible(a.end(), b.end());
      toBare += tracer.visible(a.end(), {b.p});
    }
    EXPECT_EQ(seen, 0) << "scale " << c.scale << " at " << c.by.x;
    EXPECT_EQ(toBare, 0) << "scale " << c.scale << " at " << c.by.x;
  }
}

// A large tilted floor that passes close by the origin: points on it have coordinates that are far
// smaller than its corners'.
TEST(RayTracer, LargeTiltedFloorDoesNotHitItself) {
  for (const float extent : {10.f, 1e3f, 1e5f}) {
    const std::vector<Shape> shapes{moved(
        parallelogram(Vec3f(-extent, -extent, 0), Vec3f(2 * extent, 0, 0), Vec3f(0, 2 * extent, 0)),
        tilt(), 1, Vec3f(0.1f, -0.2f, 0.05f))};
    const RayTracer tracer(shapes);
    Random random(4, 5, 6);
    int selfHits = 0;
    for (int i = 0; i < 50000; ++i) {
      const Vec3f origin = randomPoint(random) * 3.0f;
      const Vec3f direction = randomDirection(random);
      const PrimitiveId id = tracer.intersect({origin}, direction);
      if (!id.valid()) continue;
      const SurfacePoint<float> p = intersectPrimitive<float>(shapes, id, origin, direction);
      const Vec3f next = randomDirection(random);
      if (std::abs(dot(next, p.ng)) < 1e-3f) continue;
      selfHits += !tracer.escapes(p.end(), next);
    }
    EXPECT_EQ(selfHits, 0) << extent;
  }
}

// Beside a triangle of 10 km what is a tenth of a millimetre counts as if the triangle were not there.
class VastTriangle : public testing::Test {
 protected:
  static constexpr unsigned kGround = 0, kCard = 1, kBox = 2;
  static constexpr double kGap = 1e-4, kHalfCard = 0.02, kBoxAt = 0.04, kBoxWidth = 1e-3;

  VastGround world_;
  std::vector<Shape> shapes_{world_.ground(), world_.card(0, 0, kGap, kHalfCard),
                             world_.box(kBoxAt, 0, kBoxWidth), farBall()};
  RayTracer tracer_{shapes_};
  Random random_{4, 5, 6};

  Shape farBall() const { return moved(ball(20, true), tilt(), 1, world_.at(20, 30, 5)); }
  double within(double halfWidth) { return halfWidth * (2 * random_.uniformDouble() - 1); }
  // A direction that leaves the ground upwards by `sine` or more.
  Vec3f upwards(double sine) {
    for (;;) {
      const Vec3f d = randomDirection(random_);
      const double height = glm::dot(glm::dvec3(d), world_.normal());
      if (std::abs(height) >= sine) return height > 0 ? d : -d;
    }
  }
  // The ground's point below (x, y), by a ray from `height`.
  SurfacePoint<float> groundAt(double x, double y, double height) {
    const Vec3f origin = world_.at(x, y, height), down = world_.along(0, 0, -1);
    const PrimitiveId id = tracer_.intersect({origin}, down);
    EXPECT_EQ(id.shape, kGround);
    if (id.shape != kGround) return {};
    const SurfacePoint<float> point = intersectPrimitive<float>(shapes_, id, origin, down);
    EXPECT_LT(glm::length(glm::dvec3(point.p) - world_.exactly(x, y, 0)), 1e-7);
    return point;
  }
};

TEST_F(VastTriangle, ThinGapBelowACardIsThere) {
  int leaks = 0, through = 0, wrong = 0;
  for (int i = 0; i < 5000; ++i) {
    const double x = within(0.9 * kHalfCard), y = within(0.9 * kHalfCard);
    const SurfacePoint<float> point = groundAt(x, y, kGap / 2);
    const Vec3f up = upwards(0.1);
    leaks += tracer_.intersect(point.end(), up).shape != kCard;
    leaks += tracer_.escapes(point.end(), up);
    leaks += tracer_.visible(point.end(), {world_.at(0.01, 0.02, 0.3)});
    // From a distance the card is before the ground, and from its underside the ground is next.
    const Vec3f eye = world_.at(within(1), within(1), 0.2 + random_.uniformDouble());
    const Vec3f towards = glm::normalize(world_.at(x, y, kGap) - eye);
    const PrimitiveId id = tracer_.intersect({eye}, towards);
    wrong += id.shape != kCard;
    if (id.shape != kCard) continue;
    const SurfacePoint<float> card = intersectPrimitive<float>(shapes_, id, eye, towards);
    through += tracer_.intersect(card.end(), world_.along(0.3, 0.1, -1)).shape != kGround;
    through += tracer_.visible(card.end(), {world_.at(x, y, -1e-2)});
    through += !tracer_.visible(card.end(), {eye});
    through += !tracer_.visible(card.end(), point.end());
  }
  EXPECT_EQ(leaks, 0);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(through, 0);
}

TEST_F(VastTriangle, ContactShadowReachesTheBox) {
  int leaks = 0, dark = 0;
  for (int i = 0; i < 5000; ++i) {
    // Beside a wall of the box, 1 to 50 micrometres away from it, and as far up it.
    const double away = 1e-6 + 5e-5 * random_.uniformDouble();
    const double y = within(0.4 * kBoxWidth), wall = kBoxAt - kBoxWidth / 2;
    const SurfacePoint<float> point = groundAt(wall - away, y, 1e-3);
    leaks += tracer_.intersect(point.end(), world_.along(1, 0, 0.5)).shape != kBox;
    leaks += tracer_.visible(point.end(), {world_.at(wall + 0.1, y, 0.1)});
    dark += !tracer_.visible(point.end(), {world_.at(wall - 0.1, y, 0.1)});
    const Vec3f origin = world_.at(wall - 0.1, y, away), along = world_.along(1, 0, 0);
    const PrimitiveId id = tracer_.intersect({origin}, along);
    ASSERT_EQ(id.shape, kBox);
    const SurfacePoint<float> side = intersectPrimitive<float>(shapes_, id, origin, along);
    leaks += tracer_.intersect(side.end(), world_.along(-1, 0, -1)).shape != kGround;
    dark += !tracer_.visible(side.end(), point.end());
  }
  EXPECT_EQ(leaks, 0);
  EXPECT_EQ(dark, 0);
}

// From near and far, and over the edge that its two triangles share.
TEST_F(VastTriangle, DoesNotHitItself) {
  int selfHits = 0, missed = 0, total = 0;
  for (int i = 0; i < 50000; ++i) {
    const double distance = std::pow(10, within(3.5));
    const Vec3f origin = world_.at(within(distance), within(distance), 0.05 + distance / 10);
    const Vec3f down = -upwards(0.05);
    const PrimitiveId id = tracer_.intersect({origin}, down);
    if (id.valid() && id.shape != kGround) continue;
    missed += !id.valid();
    if (!id.valid()) continue;
    const SurfacePoint<float> point = intersectPrimitive<float>(shapes_, id, origin, down);
    const PrimitiveId next = tracer_.intersect(point.end(), upwards(1e-3));
    ++total;
    selfHits += next.shape == kGround;
  }
  EXPECT_GT(total, 40000);
  // Beyond the ground's end.
  EXPECT_LT(missed, total / 10);
  EXPECT_EQ(selfHits, 0);
}

// A shape that moves is looked at in the same way.
TEST_F(VastTriangle, ThatMoves) {
  MovingMesh moving;
  const auto& still = std::get<TriangleMesh>(world_.ground().geometry);
  for (const double height : {0.0, 0.3})
    for (const Vec3f& p : still.positions)
      moving.positions.push_back(p + Vec3f(world_.normal() * height));
  moving.triangles = still.triangles;
  const std::vector<Shape> shapes{{"ground", moving}, farBall()};
  const RayTracer tracer(shapes);
  int wrong = 0, selfHits = 0;
  for (int i = 0; i < 5000; ++i) {
    const float time = random_.uniform();
    const Vec3f origin = world_.at(within(1), within(1), 0.5), down = -upwards(0.1);
    const PrimitiveId id = tracer.intersect({origin}, down, 0, RayTracer::kFar, time);
    if (id.shape == 1) continue;
    wrong += !id.valid();
    if (!id.valid()) continue;
    const SurfacePoint<float> point = intersectPrimitive<float>(shapes, id, origin, down, &time);
    selfHits += tracer.intersect(point.end(), upwards(1e-3), 0, RayTracer::kFar, time).shape == 0;
    // A tenth of a millimetre above it and below.
    const Vec3f beside = Vec3f(world_.normal() * 1e-4);
    wrong += !tracer.visible({origin}, {point.p + beside}, time);
    wrong += tracer.visible({origin}, {point.p - beside}, time);
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(selfHits, 0);
}

// Planes through the origin of coordinates, where ulps are no measure.
TEST(RayTracer, LeavesFromTheOrigin) {
  const std::vector<Shape> shapes{
      parallelogram(Vec3f(-1, 0, -1), Vec3f(0, 0, 2), Vec3f(2, 0, 0)),
      parallelogram(Vec3f(-1, 0.01f, -1), Vec3f(0, 0, 2), Vec3f(2, 0, 0))};
  const RayTracer tracer(shapes);
  const Vec3f up(0, 1, 0);
  for (const Vec3f& direction : {up, glm::normalize(Vec3f(1, 0.1f, 0.3f))}) {
    EXPECT_EQ(tracer.intersect({Vec3f(0), up}, direction).shape, 1u);
    EXPECT_TRUE(tracer.escapes({Vec3f(0), up}, -direction));
  }
  EXPECT_TRUE(tracer.visible({Vec3f(0), up}, {Vec3f(0.1f, 0.01f, 0), up}));
}

// The same hits from each build, also where triangles share an edge or a corner.
TEST(RayTracer, IsTheSameEachTimeItIsBuilt) {
  const std::vector<Shape> shapes{ball(50, true), soup(20000, 0.1f, 5)};
  const RayTracer a(shapes), b(shapes);
  Random random(4, 5, 6);
  const auto& mesh = std::get<TriangleMesh>(shapes[0].geometry);
  for (int i = 0; i < 20000; ++i) {
    const Vec3f o = randomPoint(random) * 3.0f;
    const Vec3f target = mesh.positions[random.next() % mesh.positions.size()];
    const Vec3f d = glm::normalize(target - o);
    ASSERT_EQ(a.intersect({o}, d), b.intersect({o}, d));
  }
}

TEST(RayTracer, NothingToHit) {
  const std::vector<Shape> none;
  const RayTracer empty(none);
  EXPECT_FALSE(empty.intersect({}, Vec3f(0, 0, 1)).valid());
  EXPECT_TRUE(empty.visible({}, {Vec3f(0, 0, 1)}));
  EXPECT_TRUE(empty.escapes({}, Vec3f(0, 0, 1)));

  // An empty mesh does not shift the numbers of the others.
  const std::vector<Shape> shapes{meshShape({}, {}), sphere(Vec3f(0), 1)};
  const RayTracer tracer(shapes);
  EXPECT_EQ(tracer.intersect({Vec3f(0, 0, -5)}, Vec3f(0, 0, 1)), (PrimitiveId{1, 0}));
}

}  // namespace
}  // namespace h2mc
