#include "description/materials.hpp"

#include "plugins/parameter_values.hpp"

namespace grit {

void MaterialDescription::declare(const std::string& name, ContactLaw* law, Parameters& p) {
  p.add("density", density).unit("kg/m^3").symbol("rho").above(0).doc("density of the solid");
  if (law == nullptr) return p.leave_open(), p.add_values(values);
  law->declare_material(name, p);
  p.when_read([this, name, law] {
    Parameters own;
    law->declare_material(name, own);
    values = write(own);
  });
}
InterfaceDescription::InterfaceDescription(const std::string& name) : a(name.substr(0, name.find('+'))) {
  if (a.size() < name.size()) b = name.substr(a.size() + 1);
}
void InterfaceDescription::declare(ContactLaw* law, Parameters& p) {
  if (law == nullptr || b.empty()) return p.leave_open(), p.add_values(values);
  law->declare_interface(a, b, p);
  p.when_read([this, law] {
    Parameters own;
    law->declare_interface(a, b, own);
    values = write(own);
  });
}

}  // namespace grit
