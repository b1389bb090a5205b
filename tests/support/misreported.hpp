// A contact law that is right but for the energies that it reports.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "grit/contact/contact_law.hpp"

namespace grit::test {

/// Reported over right energies.
struct Misreport {
  double friction = 1, rolling = 1, viscosity = 1;
  double elastic_normal = 1, elastic_shear = 1, elastic_rolling = 1;
};

class MisreportedLaw final : public ContactLaw {
 public:
  MisreportedLaw(std::shared_ptr<ContactLaw> right, const Misreport& factors)
      : right_(std::move(right)), factors_(factors) {}

  void declare(Parameters& parameters) override { right_->declare(parameters); }
  void clear_materials() override { right_->clear_materials(); }
  void declare_material(const std::string& name, Parameters& parameters) override {
    right_->declare_material(name, parameters);
  }
  void declare_interface(const std::string& a, const std::string& b, Parameters& parameters) override {
    right_->declare_interface(a, b, parameters);
  }
  void mix(std::span<const std::string> materials, std::size_t of_bodies) override {
    right_->mix(materials, of_bodies);
  }
  std::vector<StateField> state() const override { return right_->state(); }
  LawLoop loop() const override { return right_->loop(); }
  void evaluate_pairs(PairBatch& batch) const override { evaluate(batch, &ContactLaw::evaluate_pairs); }
  void evaluate_walls(WallBatch& batch) const override { evaluate(batch, &ContactLaw::evaluate_walls); }
  void evaluate_pairs_reference(PairBatch& batch) const override {
    evaluate(batch, &ContactLaw::evaluate_pairs_reference);
  }
  Stiffness stiffness(const PairSize& pair, std::size_t a, std::size_t b) const override {
    return right_->stiffness(pair, a, b);
  }
  bool has_reach() const override { return right_->has_reach(); }
  double reach(const PairSize& pair, std::size_t a, std::size_t b) const override { return right_->reach(pair, a, b); }
  std::vector<double> reaches(double radius) const override { return right_->reaches(radius); }
  std::vector<double> mixed(std::size_t a, std::size_t b, bool wall) const override {
    return right_->mixed(a, b, wall);
  }
  ElasticEnergy energy(const PairSize& pair, std::size_t a, std::size_t b,
                       std::span<const double> state) const override {
    const ElasticEnergy right = right_->energy(pair, a, b, state);
    return {factors_.elastic_normal * right.normal, factors_.elastic_shear * right.shear,
            factors_.elastic_rolling * right.rolling};
  }

 private:
  template <class Batch>
  void evaluate(Batch& batch, void (ContactLaw::*how)(Batch&) const) const {
    Losses right;
    Losses* const losses = std::exchange(batch.losses, batch.losses != nullptr ? &right : nullptr);
    ((*right_).*how)(batch);
    batch.losses = losses;
    if (losses == nullptr) return;
    losses->friction += factors_.friction * right.friction, losses->rolling += factors_.rolling * right.rolling;
    losses->viscosity += factors_.viscosity * right.viscosity;
  }

  std::shared_ptr<ContactLaw> right_;
  Misreport factors_;
};

}  // namespace grit::test
