// Errors, by cause. Library code throws them; only the command line prints them and exits.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace grit {

/// Base class of all errors of grit. what(): where, what was found, what is allowed and what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One problem in a description.
struct Problem {
  std::string file;     ///< path, or "--set"
  int line = 0;         ///< from 1; 0 if there is none
  std::string pointer;  ///< JSON pointer (RFC 6901)
  std::string message;  ///< what was found and what is allowed
};

/// A description that cannot be run, with all its problems.
class DescriptionError : public Error {
 public:
  explicit DescriptionError(std::vector<Problem> problems) : Error(text(problems)), problems_(std::move(problems)) {}
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  static std::string text(const std::vector<Problem>& problems) {
    std::string all;
    for (const auto& p : problems) {
      if (!all.empty()) all += '\n';
      all += p.file;
      if (p.line > 0) all += ':' + std::to_string(p.line);
      if (!p.pointer.empty()) all += ": " + p.pointer;
      all += ": " + p.message;
    }
    return all;
  }
  std::vector<Problem> problems_;
};

/// "found …; allowed is …". After a question, as of did_you_mean(), a new sentence begins.
inline std::string fault_text(const std::string& found, const std::string& allowed) {
  return "found " + found + (found.ends_with('?') ? " Allowed is " : "; allowed is ") + allowed;
}

/// Faults of a component's parameters that show when it is prepared or expanded, e.g. a missing file or wall. grit
/// reports each with its line and pointer in the description.
class ParameterError : public Error {
 public:
  /// One parameter that is at fault.
  struct Fault {
    std::string key;  ///< of the parameter; "" for the whole object, "outlets/left" for a nested one
    std::string found, allowed;
    std::string message() const { return fault_text(found, allowed); }
  };
  explicit ParameterError(std::vector<Fault> faults) : Error(text(faults)), faults_(std::move(faults)) {}
  const std::vector<Fault>& faults() const { return faults_; }

 private:
  static std::string text(const std::vector<Fault>& faults) {
    std::string all;
    for (const Fault& fault : faults)
      all += (all.empty() ? "" : "\n") + fault.key + (fault.key.empty() ? "" : ": ") + fault.message();
    return all;
  }
  std::vector<Fault> faults_;
};

/// A plugin that cannot be loaded or violates its interface.
class PluginError : public Error {
 public:
  using Error::Error;
};

/// Guards that stop a simulation.
enum class Guard {
  none,          ///< no guard: a stage did not end, or missed an expected value
  overlap,       ///< a contact is too deep: /guards/overlap
  travel,        ///< a body or wall moves too far in one step: /guards/travel
  energy,        ///< energy was created: /guards/energy
  finite,        ///< a velocity is infinite or NaN
  domain,        ///< a body left through a closed side
  period,        ///< a period is too short for the bodies
  arrival,       ///< no space for the new bodies of a stage
  critical_step  ///< the prescribed time step is above the critical time step
};

/// A simulation that a guard stopped, or a stage that failed.
class NumericsError : public Error {
 public:
  explicit NumericsError(const std::string& what) : Error(what), cause_(what) {}
  /// `when`: the instant; `cause`: what was found and what to do; `keys`: path from the root of the description to the
  /// part that caused the failure.
  NumericsError(const std::string& when, const std::string& cause, Guard guard, std::vector<std::string> keys)
      : Error(when + ": " + cause), cause_(cause), guard_(guard), keys_(std::move(keys)) {}
  /// what() without the instant.
  const std::string& cause() const { return cause_; }
  Guard guard() const { return guard_; }
  const std::vector<std::string>& keys() const { return keys_; }

 private:
  std::string cause_;
  Guard guard_ = Guard::none;
  std::vector<std::string> keys_;
};

/// A file that cannot be read or written.
class FileError : public Error {
 public:
  using Error::Error;
};

}  // namespace grit
