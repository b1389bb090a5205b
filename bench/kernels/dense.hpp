// Dense grains for single kernels. Internal types of the kernel are used here only.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "contact/spatial_order.hpp"
#include "support/packing.hpp"
#include "support/scene.hpp"

namespace grit::bench {

inline constexpr double spacing = 0.5e-3;  // m
inline constexpr double time_step = 2.5e-7;

/// Roughly `about` grains on a disturbed cubic lattice, with about 4.5 contacts each, as in sand.
inline std::vector<test::Grain> grains(std::size_t about) {
  const int side = static_cast<int>(std::lround(std::cbrt(static_cast<double>(about))));
  auto all = test::jumble({side, side, side}, spacing, 0.01, 1);
  for (test::Grain& grain : all) grain.radius *= 1.02;
  return all;
}

/// Parameters of the dense box.
inline Description material(const std::string& law) {
  if (law == "hertz-mindlin") return {{"young_modulus", 3.64e9}, {"poisson_ratio", 0.3}, {"restitution", 0.85}};
  if (law == "linear-frictional") return {{"contact_modulus", 300e6}, {"restitution", 0.85}};
  return {{"contact_modulus", 300e6}};
}

/// Bodies, contacts and forces, without stages and guards of a scene.
class Dense {
 public:
  Dense(const std::string& law, std::size_t about)
      : scene_(test::scene_of(test::description(law, material(law), {{Vec3::Zero(), spacing}}))), team_(1) {
    law_ = LiveScene(scene_).components().law;
    const std::array<std::string, 1> names{"grain"};
    law_->mix(names, names.size());
    for (const test::Grain& g : grains(about)) {
      const double mass = 2600 * 4 / 3 * std::numbers::pi * std::pow(g.radius, 3);
      bodies_.add(g.position, g.radius, mass, 0.4 * mass * g.radius * g.radius, 0, g.velocity, g.spin);
    }
    bodies_.finish({});
    const Vec3 open = Vec3::Constant(std::numeric_limits<double>::infinity());
    cell_ = {-open, open};
    bodies_.reorder(spatial_order(bodies_, cell_, team_), team_);
    sum_.assign(bodies_.count() + 1, {});
    search();
    contacts();
    search();  // again, since contacts are known now
    contacts();
  }

  void search() { find(), rebuild(); }
  /// Neighbour search only.
  void find() {
    skins_.reset(std::vector(chunks_of(bodies_.count()), 0.03 * spacing), 0, 0);
    search_.build(bodies_, cell_, skins_, team_);
  }
  /// Builds the contact table from the pairs found.
  void rebuild() {
    Ranks alone;
    alone.resize(chunks_of(bodies_.count()));
    pairs_.rebuild(bodies_, search_, false, law_->state(), {}, {}, alone, team_);
  }
  void contacts() {
    for (std::size_t chunk = 0; chunk < chunks_of(bodies_.count()); ++chunk) {
      const std::size_t first = chunk * chunk_bodies, last = std::min(bodies_.count(), first + chunk_bodies);
      std::fill(sum_.begin() + static_cast<std::ptrdiff_t>(first), sum_.begin() + static_cast<std::ptrdiff_t>(last),
                BodySum{});
      for (const ContactTable::Kind kind : {ContactTable::Kind::within, ContactTable::Kind::across})
        pairs_.evaluate(kind, chunk, {*law_, bodies_, true, &no_shift_, time_step, skins_}, sum_.data(), nullptr);
    }
  }
  /// Gathers forces of contacts between chunks for their second bodies.
  void gather() {
    for (std::size_t chunk = 0; chunk < chunks_of(bodies_.count()); ++chunk) pairs_.gather(chunk, sum_.data());
  }
  /// All of the arithmetic with a result of zero motion; otherwise the grains would fly apart.
  void motion() {
    MotionStep step{.settings = {},
                    .kick = 0,
                    .drift = 0,
                    .flowed = 0,
                    .strain_rate = Vec3::Zero(),
                    .centre = Vec3::Zero(),
                    .energies = false};
    step.settings.local_damping = 0.08;
    for (std::size_t chunk = 0; chunk < chunks_of(bodies_.count()); ++chunk)
      pairs_.gather(chunk, sum_.data()), move_bodies(chunk, bodies_, sum_.data(), step);
  }

  std::size_t count() const { return bodies_.count(); }
  std::size_t touching() const { return pairs_.touching_count(); }
  /// Fraction of contacts between bodies of different chunks, which write a row.
  double across() const {
    std::size_t across = 0;
    for (std::size_t c = 0; c < pairs_.candidates(); ++c)
      if (pairs_.contacts(c) && pairs_.a(c) / chunk_bodies != pairs_.b(c) / chunk_bodies) ++across;
    return static_cast<double>(across) / static_cast<double>(touching());
  }

 private:
  Scene scene_;
  std::shared_ptr<ContactLaw> law_;
  Team team_;
  Bodies bodies_;
  Cell cell_;
  Skins skins_;
  NeighbourSearch search_;
  ContactTable pairs_;
  LargeArray<BodySum> sum_;
  ImageShift no_shift_{};
};

}  // namespace grit::bench
