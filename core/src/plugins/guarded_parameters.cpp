#include "plugins/guarded_parameters.hpp"

#include <memory>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "plugins/boundary.hpp"

namespace grit {
namespace {

/// Passes every call to a choice of a plugin.
class GuardedChoice final : public Choice {
  template <class Call>
  decltype(auto) guard(std::string_view function, Call&& call) const {
    return at_boundary(title_, function, std::forward<Call>(call));
  }

 public:
  GuardedChoice(std::shared_ptr<Choice> choice, std::string title)
      : choice_(std::move(choice)), title_(std::move(title)) {}
  std::string what() const override {
    return guard("what()", [&] { return choice_->what(); });
  }
  std::vector<std::string> types() const override {
    return guard("types()", [&] { return choice_->types(); });
  }
  std::string type_doc(const std::string& type) const override {
    return guard("type_doc()", [&] { return choice_->type_doc(type); });
  }
  std::string how_to_add() const override {
    return guard("how_to_add()", [&] { return choice_->how_to_add(); });
  }
  std::string type() const override {
    return guard("type()", [&] { return choice_->type(); });
  }
  void choose(const std::string& type) override {
    at_boundary_unless_refused(title_, "choose()", [&] { choice_->choose(type); });
  }
  void declare(Parameters& parameters) override {
    guard_declared(title_, "declare() of a choice", parameters, [&] { choice_->declare(parameters); });
  }
  std::unique_ptr<Choice> twin() const override {
    std::shared_ptr<Choice> twin = guard("twin()", [&] { return choice_->twin(); });
    return std::make_unique<GuardedChoice>(std::move(twin), title_);
  }

 private:
  std::shared_ptr<Choice> choice_;
  std::string title_;
};

}  // namespace

void guard_declared(const std::string& title, std::string_view function, Parameters& parameters,
                    const std::function<void()>& declare) {
  const std::size_t first_entry = parameters.entries().size(), first_check = parameters.checks().size(),
                    first_call = parameters.calls_when_read().size();
  const Choice* const choice_before = parameters.choice();
  at_boundary(title, function, declare);
  for (std::size_t i = first_check; i < parameters.checks().size(); ++i) {
    auto& run = parameters.checks()[i].run;
    run = [title, run = std::move(run)](const Complain& complain) {
      at_boundary(title, "check of parameters", [&] { run(complain); });
    };
  }
  for (std::size_t i = first_call; i < parameters.calls_when_read().size(); ++i) {
    auto& call = parameters.calls_when_read()[i];
    call = [title, call = std::move(call)] { at_boundary(title, "when_read()", call); };
  }
  if (Choice* const choice = parameters.choice(); choice != choice_before)
    parameters.choose(std::make_shared<GuardedChoice>(std::shared_ptr<Choice>(std::shared_ptr<void>(), choice), title));
  const auto nested = [&title](auto& of_object) {
    of_object = [title, inner = std::move(of_object)](auto&&... given) {
      Parameters& own = std::get<sizeof...(given) - 1>(std::forward_as_tuple(given...));
      guard_declared(title, "declare() of a nested object", own, [&] { inner(given...); });
    };
  };
  for (std::size_t i = first_entry; i < parameters.entries().size(); ++i)
    std::visit(
        [&]<class T>(T& target) {
          if constexpr (requires { target.create; }) nested(target.create);
          if constexpr (requires { target.append; }) nested(target.append);
          if constexpr (requires { target.insert; }) nested(target.insert);
          if constexpr (requires { target.declare; }) nested(target.declare);
        },
        parameters.entries()[i].target());
}

}  // namespace grit
