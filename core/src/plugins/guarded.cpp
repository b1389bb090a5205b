#include "plugins/guarded.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "grit/toolkit/limited_fields.hpp"
#include "plugins/boundary.hpp"
#include "plugins/guarded_parameters.hpp"
#include "plugins/returned.hpp"

namespace grit {
namespace {

/// What guarded components have in common.
template <class Interface>
class Guard : public Interface {
 public:
  Guard(std::shared_ptr<Interface> made, std::string title) : made_(std::move(made)), title_(std::move(title)) {}
  void declare(Parameters& parameters) final {
    guard_declaration("declare()", parameters, [&] { made().declare(parameters); });
  }

 protected:
  Interface& made() const { return *made_; }

  template <class Call>
  decltype(auto) guard(std::string_view function, Call&& call) const {
    return at_boundary(title_, function, std::forward<Call>(call));
  }
  template <class Call>
  decltype(auto) guard_unless_refused(std::string_view function, Call&& call) const {
    return at_boundary_unless_refused(title_, function, std::forward<Call>(call));
  }
  /// What `call` returns, unless `fault` finds something wrong with it.
  template <class Call, class Fault>
  auto guard_value(std::string_view function, Call&& call, const Fault& fault) const {
    auto value = guard(function, std::forward<Call>(call));
    expect(function, "returned", fault(value));
    return value;
  }
  template <class Call>
  auto guard_value(std::string_view function, Call&& call) const {
    return guard_value(function, std::forward<Call>(call), [](const auto& value) { return fault_of(value); });
  }
  /// Throws the fault that `function` made, if there is one.
  void expect(std::string_view function, std::string_view did, const std::string& fault) const {
    if (!fault.empty()) throw_boundary_fault(title_, function, did, fault);
  }
  void guard_declaration(std::string_view function, Parameters& parameters,
                         const std::function<void()>& declare) const {
    guard_declared(title_, function, parameters, declare);
  }
  /// A checkpoint may be refused; saving has nothing to refuse.
  void guard_serialize(Archive& archive) const {
    const auto serialize = [&] { made().serialize(archive); };
    if (archive.restoring()) guard_unless_refused("serialize()", serialize);
    else guard("serialize()", serialize);
  }

 private:
  std::shared_ptr<Interface> made_;
  std::string title_;
};

class GuardedBodyKind final : public Guard<BodyKind> {
 public:
  using Guard::Guard;
  void prepare() override {
    clump_.reset();
    guard_unless_refused("prepare()", [&] { made().prepare(); });
  }
  const ClumpShape* clump() const override {
    if (!clump_) clump_ = checked_clump();
    return clump_->empty() ? nullptr : clump_->data();
  }
  double volume(double radius) const override {
    return guard_value(
        "volume()", [&] { return made().volume(radius); }, fault_of_positive);
  }
  double inertia(double radius, double mass) const override {
    return guard_value(
        "inertia()", [&] { return made().inertia(radius, mass); }, fault_of_positive);
  }

 private:
  /// A copy of the clump, if there is one.
  std::vector<ClumpShape> checked_clump() const {
    const ClumpShape* const shape = guard("clump()", [&] { return made().clump(); });
    if (shape == nullptr) return {};
    expect("clump()", "returned", fault_of(*shape));
    return {*shape};
  }

  mutable std::optional<std::vector<ClumpShape>> clump_;  // since the first call
};

class GuardedContactLaw final : public Guard<ContactLaw> {
 public:
  using Guard::Guard;
  void clear_materials() override {
    guard("clear_materials()", [&] { made().clear_materials(); });
  }
  void declare_material(const std::string& name, Parameters& parameters) override {
    guard_declaration("declare_material()", parameters, [&] { made().declare_material(name, parameters); });
  }
  void declare_interface(const std::string& a, const std::string& b, Parameters& parameters) override {
    guard_declaration("declare_interface()", parameters, [&] { made().declare_interface(a, b, parameters); });
  }
  void mix(std::span<const std::string> materials, std::size_t of_bodies) override {
    guard("mix()", [&] { made().mix(materials, of_bodies); });
  }
  std::vector<StateField> state() const override {
    return guard_value("state()", [&] { return made().state(); });
  }
  LawLoop loop() const override {
    return guard("loop()", [&] { return made().loop(); });
  }
  void evaluate_pairs(PairBatch& batch) const override {
    guard("evaluate_pairs()", [&] { made().evaluate_pairs(batch); });
  }
  void evaluate_walls(WallBatch& batch) const override {
    guard("evaluate_walls()", [&] { made().evaluate_walls(batch); });
  }
  void evaluate_pairs_reference(PairBatch& batch) const override {
    guard("evaluate_pairs_reference()", [&] { made().evaluate_pairs_reference(batch); });
  }
  std::optional<DeviceLaw> device() const override {
    return guard("device()", [&] { return made().device(); });
  }
  void evaluate_device_pairs(const DevicePairs& pairs, const void* parameters, std::uint32_t first,
                             std::uint32_t last) const override {
    guard("evaluate_device_pairs()", [&] { made().evaluate_device_pairs(pairs, parameters, first, last); });
  }
  Stiffness stiffness(const PairSize& pair, std::size_t material_a, std::size_t material_b) const override {
    return guard("stiffness()", [&] { return made().stiffness(pair, material_a, material_b); });
  }
  bool has_reach() const override {
    return guard("has_reach()", [&] { return made().has_reach(); });
  }
  double reach(const PairSize& pair, std::size_t material_a, std::size_t material_b) const override {
    return guard_value(
        "reach()", [&] { return made().reach(pair, material_a, material_b); }, fault_of_not_negative);
  }
  std::vector<double> reaches(double radius) const override {
    auto reaches = guard("reaches()", [&] { return made().reaches(radius); });
    for (const double reach : reaches) expect("reaches()", "returned", fault_of_not_negative(reach));
    return reaches;
  }
  std::vector<double> mixed(std::size_t material_a, std::size_t material_b, bool wall) const override {
    return guard("mixed()", [&] { return made().mixed(material_a, material_b, wall); });
  }
  ElasticEnergy energy(const PairSize& pair, std::size_t material_a, std::size_t material_b,
                       std::span<const double> state) const override {
    return guard("energy()", [&] { return made().energy(pair, material_a, material_b, state); });
  }
};

class GuardedEngine final : public Guard<Engine> {
 public:
  using Guard::Guard;
  Phase phase() const override {
    return guard_value("phase()", [&] { return made().phase(); });
  }
  StateRequest needs() const override {
    return guard("needs()", [&] { return made().needs(); });
  }
  void settings(MotionSettings& motion) const override {
    guard("settings()", [&] { made().settings(motion); });
    expect("settings()", "set", fault_of(motion));
  }
  void forces(const World& world, std::span<Row> force, std::span<Row> moment) const override {
    guard("forces()", [&] { made().forces(world, force, moment); });
  }
  bool removes(const World& world, const Vec3& centre) const override {
    return guard("removes()", [&] { return made().removes(world, centre); });
  }
  EngineRates rates(const World& world) const override {
    return guard_value("rates()", [&] { return made().rates(world); });
  }
  void serialize(Archive& archive) override { guard_serialize(archive); }
};

class GuardedGeometry final : public Guard<Geometry> {
 public:
  using Guard::Guard;
  void prepare() override {
    guard_unless_refused("prepare()", [&] { made().prepare(); });
    bounds_ = bounds();
    if (is_triangulated()) triangle_count_ = triangles().size() / 3;
  }
  Bounds bounds() const override {
    return bounds_ ? *bounds_ : guard_value("bounds()", [&] { return made().bounds(); });
  }
  bool hollow() const override {
    return guard("hollow()", [&] { return made().hollow(); });
  }
  double area() const override {
    return guard_value(
        "area()", [&] { return made().area(); }, fault_of_not_negative);
  }
  Vec3 normal() const override {
    return guard_value(
        "normal()", [&] { return made().normal(); }, fault_of_normal);
  }
  bool flat() const override {
    return guard("flat()", [&] { return made().flat(); });
  }
  void find_contacts(const Pose& pose, std::span<const Sphere> spheres,
                     std::vector<SurfaceContact>& contacts) const override {
    const std::size_t before = contacts.size();
    guard("find_contacts()", [&] { made().find_contacts(pose, spheres, contacts); });
    if (contacts.size() < before) expect("find_contacts()", "removed", "contacts; allowed is to append them");
    expect("find_contacts()", "found", fault_of_contacts(std::span(contacts).subspan(before), spheres));
  }
  bool near(const Pose& pose, const Vec3& centre, double reach) const override {
    return guard("near()", [&] { return made().near(pose, centre, reach); });
  }
  std::vector<Vec3> triangles() const override {
    return guard_value(
        "triangles()", [&] { return made().triangles(); }, fault_of_triangles);
  }
  std::optional<std::uint32_t> triangle_of(std::uint32_t feature) const override {
    const auto triangle = guard("triangle_of()", [&] { return made().triangle_of(feature); });
    if (triangle && triangle_count_ && *triangle >= *triangle_count_)
      expect("triangle_of()", "returned",
             fmt::format("{}; allowed is an index of its {} triangles", *triangle, *triangle_count_));
    return triangle;
  }

 private:
  std::optional<Bounds> bounds_;               // since it was prepared, from when on it does not change
  std::optional<std::size_t> triangle_count_;  // the same, of a triangulated one
};

class GuardedProbe : public Guard<Probe> {
 public:
  using Guard::Guard;
  StateRequest needs() const override {
    return guard("needs()", [&] { return made().needs(); });
  }
  void prepare(const World& world) override {
    guard_unless_refused("prepare()", [&] { made().prepare(world); });
  }
  std::vector<Channel> channels() const override {
    return guard_value("channels()", [&] { return made().channels(); });
  }
  void sample(const World& world, ChannelValues& values) override {
    guard("sample()", [&] { made().sample(world, values); });
  }
  std::vector<Field> fields(const World& world) override {
    return guard_value("fields()", [&] { return made().fields(world); });
  }
  void serialize(Archive& archive) override { guard_serialize(archive); }
};

class GuardedLimitedProbe final : public GuardedProbe, public LimitedFields {
 public:
  GuardedLimitedProbe(std::shared_ptr<Probe> made, const LimitedFields& limited, std::string title)
      : GuardedProbe(std::move(made), std::move(title)), limited_(limited) {}
  void check_fields(const World& world) const override {
    guard_unless_refused("check_fields()", [&] { limited_.check_fields(world); });
  }

 private:
  const LimitedFields& limited_;  // the same probe
};

class GuardedScenario final : public Guard<Scenario> {
 public:
  using Guard::Guard;
  Description expand() const override {
    return guard_unless_refused("expand()", [&] { return made().expand(); });
  }
};

}  // namespace

std::shared_ptr<BodyKind> guarded(std::shared_ptr<BodyKind> made, std::string title) {
  return std::make_shared<GuardedBodyKind>(std::move(made), std::move(title));
}
std::shared_ptr<ContactLaw> guarded(std::shared_ptr<ContactLaw> made, std::string title) {
  return std::make_shared<GuardedContactLaw>(std::move(made), std::move(title));
}
std::shared_ptr<Engine> guarded(std::shared_ptr<Engine> made, std::string title) {
  return std::make_shared<GuardedEngine>(std::move(made), std::move(title));
}
std::shared_ptr<Geometry> guarded(std::shared_ptr<Geometry> made, std::string title) {
  return std::make_shared<GuardedGeometry>(std::move(made), std::move(title));
}
std::shared_ptr<Probe> guarded(std::shared_ptr<Probe> made, std::string title) {
  if (const auto* const limited = dynamic_cast<const LimitedFields*>(made.get()))
    return std::make_shared<GuardedLimitedProbe>(std::move(made), *limited, std::move(title));
  return std::make_shared<GuardedProbe>(std::move(made), std::move(title));
}
std::shared_ptr<Scenario> guarded(std::shared_ptr<Scenario> made, std::string title) {
  return std::make_shared<GuardedScenario>(std::move(made), std::move(title));
}

}  // namespace grit
