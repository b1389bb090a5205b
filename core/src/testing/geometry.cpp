#include "grit/testing/geometry.hpp"

#include <thread>

namespace grit {

int geometry_contract() { return 0; }

namespace {

TEST_P(GeometryContract, AppendsInTheOrderOfSpheresThenFeatures) {
  std::vector<Sphere> spheres;
  for (std::uint32_t i = 0; i < samples; ++i) {
    spheres.push_back(draw_sphere());
    spheres.back().body = samples - i;  // the order of the spheres matters, not that of their ids
  }
  const SurfaceContact first{Vec3::UnitX(), 1, samples + 1, 0};
  std::vector<SurfaceContact> contacts{first};
  shape().find_contacts({}, spheres, contacts);
  ASSERT_GT(contacts.size(), samples / 100u) << "too few samples are in contact";
  EXPECT_EQ(contacts.front().body, first.body) << "contacts are appended";
  for (std::size_t i = 1; i < contacts.size(); ++i) {
    EXPECT_GE(contacts[i - 1].body, contacts[i].body);
    if (contacts[i - 1].body == contacts[i].body) {
      EXPECT_LT(contacts[i - 1].feature, contacts[i].feature);
    }
  }
}

TEST_P(GeometryContract, FindsContactsOfManySpheresAsOfEachAlone) {
  std::vector<Sphere> spheres;
  std::vector<SurfaceContact> one_by_one, together;
  for (std::uint32_t i = 0; i < samples; ++i) {
    spheres.push_back(draw_sphere());
    spheres.back().body = i;
    shape().find_contacts({}, {&spheres.back(), 1}, one_by_one);
  }
  shape().find_contacts({}, spheres, together);
  ASSERT_EQ(together.size(), one_by_one.size());
  for (std::size_t i = 0; i < together.size(); ++i) {
    EXPECT_EQ(together[i].body, one_by_one[i].body);
    EXPECT_EQ(together[i].feature, one_by_one[i].feature);
    EXPECT_EQ(together[i].overlap, one_by_one[i].overlap) << "to the last bit";
    EXPECT_EQ(together[i].normal, one_by_one[i].normal) << "to the last bit";
  }
}

TEST_P(GeometryContract, EachContactLiesOnTheSurfaceAlongItsUnitNormal) {
  for (int i = 0; i < samples; ++i) {
    const Sphere sphere = draw_sphere();
    for (const SurfaceContact& contact : contacts_of(shape(), sphere.centre, sphere.radius)) {
      EXPECT_NEAR(contact.normal.norm(), 1, 1e-15);
      EXPECT_GT(contact.overlap, 0);
      if (!one().in_front(sphere.centre)) continue;
      const Vec3 point = sphere.centre + (sphere.radius - contact.overlap) * contact.normal;
      EXPECT_LE(distance(point), one().facet_error + rounding());
    }
  }
}

TEST_P(GeometryContract, NormalsPointIntoTheShape) {
  for (int i = 0; i < samples; ++i) {
    const Sphere sphere = draw_sphere();
    for (const SurfaceContact& contact : contacts_of(shape(), sphere.centre, sphere.radius)) {
      const double step = 1e-3 * (sphere.radius - contact.overlap);
      if (step < 1e-6 * sphere.radius) continue;
      const Vec3 closer = sphere.centre + step * contact.normal;
      const auto after = contacts_of(shape(), closer, sphere.radius);
      const auto same = std::find_if(after.begin(), after.end(),
                                     [&](const SurfaceContact& t) { return t.feature == contact.feature; });
      ASSERT_NE(same, after.end());
      EXPECT_NEAR(same->overlap, contact.overlap + step, rounding());
    }
  }
}

TEST_P(GeometryContract, OverlapIsRadiusLessDistance) {
  int touching = 0;
  const double error = one().facet_error + rounding();
  for (int i = 0; i < samples; ++i) {
    const Sphere sphere = draw_sphere();
    if (!one().in_front(sphere.centre)) continue;
    double overlap = 0;
    for (const SurfaceContact& contact : contacts_of(shape(), sphere.centre, sphere.radius))
      overlap = std::max(overlap, contact.overlap);
    EXPECT_NEAR(overlap, std::max(sphere.radius - distance(sphere.centre), 0.0), error) << sphere.centre.transpose();
    touching += overlap > 0;
  }
  EXPECT_GT(touching, samples / 100) << "too few samples are in contact";
}

TEST_P(GeometryContract, NearNeverMissesAContact) {
  int touching = 0;
  for (int i = 0; i < samples; ++i) {
    const Sphere sphere = draw_sphere();
    const Pose pose = i % 2 == 0 ? Pose{} : draw_pose();
    const Vec3 centre = pose.to_world(sphere.centre);
    if (contacts_of(shape(), centre, sphere.radius, pose).empty()) continue;
    ++touching;
    EXPECT_TRUE(shape().near(pose, centre, sphere.radius));
    EXPECT_TRUE(shape().near(pose, centre, 2 * sphere.radius));
  }
  EXPECT_GT(touching, samples / 100) << "too few samples are in contact";
}

TEST_P(GeometryContract, NearIsTrueOfALargerSphereAroundOneThatIsNear) {
  int near = 0;
  for (int i = 0; i < samples; ++i) {
    const Sphere sphere = draw_sphere();
    const Pose pose = i % 2 == 0 ? Pose{} : draw_pose();
    const Vec3 centre = pose.to_world(sphere.centre);
    if (!shape().near(pose, centre, sphere.radius)) continue;
    ++near;
    const Vec3 away = draw(Vec3::Constant(-1), Vec3::Constant(1)) * size();
    EXPECT_TRUE(shape().near(pose, centre + away, (1 + 1e-12) * (away.norm() + sphere.radius)))
        << centre.transpose() << ", away " << away.transpose();
  }
  EXPECT_GT(near, samples / 100) << "too few samples are near";
}

TEST_P(GeometryContract, NearExcludesMostSpheres) {
  int far = 0;
  const double reach = 1e-3 * size();
  for (int i = 0; i < samples; ++i) far += !shape().near({}, draw(one().where.low, one().where.high), reach);
  EXPECT_GT(far, samples / 10);
}

TEST_P(GeometryContract, MovedShapeHasTheContactsOfTheInverselyMovedSphere) {
  for (int i = 0; i < samples; ++i) {
    const Sphere sphere = draw_sphere();
    const Pose pose = draw_pose();
    const auto here = contacts_of(shape(), sphere.centre, sphere.radius);
    const auto there = contacts_of(shape(), pose.to_world(sphere.centre), sphere.radius, pose);
    const double tolerance = 4 * rounding();
    const auto grazes = [&](const SurfaceContact& contact) { return contact.overlap < tolerance; };
    if (std::any_of(here.begin(), here.end(), grazes) || std::any_of(there.begin(), there.end(), grazes)) continue;
    ASSERT_EQ(here.size(), there.size()) << sphere.centre.transpose();
    for (std::size_t k = 0; k < here.size(); ++k) {
      EXPECT_EQ(here[k].feature, there[k].feature);
      EXPECT_NEAR(here[k].overlap, there[k].overlap, tolerance);
      const double from = std::abs(sphere.radius - here[k].overlap);
      EXPECT_LE((pose.turn * here[k].normal - there[k].normal).norm(), 1e-14 + 4 * tolerance / from);
    }
  }
}

TEST_P(GeometryContract, BoundsHoldAllTriangles) {
  ASSERT_EQ(triangles_.size() % 3, 0u);
  const Bounds bounds = shape().bounds();
  for (const Vec3& corner : triangles_)
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(corner[axis], bounds.low[axis] - rounding());
      EXPECT_LE(corner[axis], bounds.high[axis] + rounding());
    }
}

TEST_P(GeometryContract, DefinesAreaAndNormalOfItsPressure) {
  const double length = shape().normal().norm();
  EXPECT_GE(shape().area(), 0);
  EXPECT_TRUE(length == 0 || std::abs(length - 1) < 1e-15) << length;
  if (shape().area() > 0) {
    EXPECT_GT(length, 0);
  }
}

// The overlap changes at most as fast as the centre moves; the normal at most as fast as the direction of the centre
// from the surface, or from the centre of curvature of a concave surface.
TEST_P(GeometryContract, ContactsAreContinuousAlongPaths) {
  constexpr int steps = 2000;
  for (const Path& way : one().across) {
    const double step = (way.to - way.from).norm() / steps, radius = one().radius;
    std::vector<SurfaceContact> before;
    bool touched = false;
    for (int i = 0; i <= steps; ++i) {
      const auto now = contacts_of(shape(), way.from + i * (way.to - way.from) / steps, radius);
      const auto compare = [&](const SurfaceContact& contact, const std::vector<SurfaceContact>& own,
                               const std::vector<SurfaceContact>& others) {
        const auto of = [](const std::vector<SurfaceContact>& contacts, std::uint32_t feature) {
          return std::find_if(contacts.begin(), contacts.end(),
                              [&](const SurfaceContact& t) { return t.feature == feature; });
        };
        auto other = of(others, contact.feature);
        if (other == others.end() && one().hands_on)
          other = std::find_if(others.begin(), others.end(), [&](const SurfaceContact& t) {
            return t.normal.dot(contact.normal) > 0.9 && of(own, t.feature) == own.end();
          });
        const double overlap = other == others.end() ? 0 : other->overlap;
        EXPECT_LE(std::abs(contact.overlap - overlap), 1.001 * step + rounding())
            << "feature " << contact.feature << ", step " << i;
        if (other != others.end()) {
          const double off = radius - contact.overlap, pivot = std::min(off, one().hollow_radius - off);
          EXPECT_LE((contact.normal - other->normal).norm(), 1.01 * step / pivot + 1e-12) << "step " << i;
        }
      };
      if (i > 0) {
        for (const SurfaceContact& contact : now) compare(contact, now, before);
        for (const SurfaceContact& contact : before) compare(contact, before, now);
      }
      touched = touched || !now.empty();
      before = now;
    }
    EXPECT_TRUE(touched) << "a path without contact tests nothing";
  }
}

TEST_P(GeometryContract, OneFeatureAlongAFlank) {
  constexpr int steps = 500;
  for (const Path& way : one().flanks) {
    std::optional<std::uint32_t> feature;
    for (int i = 0; i <= steps; ++i) {
      const auto now = contacts_of(shape(), way.from + i * (way.to - way.from) / steps, one().radius);
      ASSERT_EQ(now.size(), 1u) << "step " << i;
      EXPECT_EQ(now.front().feature, feature.value_or(now.front().feature)) << "step " << i;
      feature = now.front().feature;
    }
  }
}

TEST_P(GeometryContract, GivesTheSameContactsInSeveralThreads) {
  std::vector<Sphere> spheres;
  for (int i = 0; i < samples; ++i) spheres.push_back(draw_sphere());
  std::vector<std::vector<SurfaceContact>> contacts(4);
  std::vector<std::thread> threads;
  for (auto& mine : contacts) threads.emplace_back([&] { shape().find_contacts({}, spheres, mine); });
  for (auto& thread : threads) thread.join();
  for (const auto& mine : contacts) {
    ASSERT_EQ(mine.size(), contacts.front().size());
    for (std::size_t i = 0; i < mine.size(); ++i) {
      EXPECT_EQ(mine[i].body, contacts.front()[i].body);
      EXPECT_EQ(mine[i].overlap, contacts.front()[i].overlap);
      EXPECT_EQ(mine[i].normal, contacts.front()[i].normal);
    }
  }
}

}  // namespace
}  // namespace grit
