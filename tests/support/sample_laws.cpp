// SPDX-License-Identifier: AGPL-3.0-or-later
#include "tests/support/sample_laws.hpp"

namespace palpate::test {

std::vector<fem::LawConstants> sample_laws(double poisson) {
  fem::FibreField fibres;
  fibres.first = {1, 0.3, 0.1};
  fibres.second = {0, 1, 0.2};
  fibres.angle = 0.6;
  fibres.families = 2;
  std::vector<fem::LawConstants> laws{
      {"neo-hookean", {{"young", 10e3}}},
      {"mooney-rivlin", {{"C10", 1.2e3}, {"C01", 0.5e3}}},
      {"mooney-rivlin-5",
       {{"C10", 0.9e3}, {"C01", 0.7e3}, {"C20", 0.4e3}, {"C11", 0.2e3}, {"C02", 0.3e3}}},
      {"yeoh", {{"C10", 1.5e3}, {"C20", 0.4e3}, {"C30", 0.2e3}}},
      {"ogden-1", {{"mu_1", 3e3}, {"alpha_1", -4.7}}},
      {"ogden-2", {{"mu_1", 2e3}, {"alpha_1", 3.5}, {"mu_2", 1e3}, {"alpha_2", -6}}},
      {"ogden-3",
       {{"mu_1", 2e3},
        {"alpha_1", 1.3},
        {"mu_2", 0.5e3},
        {"alpha_2", 9},
        {"mu_3", 0.7e3},
        {"alpha_3", -2}}},
      {"demiray-fung", {{"mu", 3e3}, {"b", 1.5}}},
      {"veronda-westmann", {{"C1", 1.5e3}, {"C2", 2}}},
      {"gent", {{"mu", 3e3}, {"J_m", 12}}},
      {"arruda-boyce", {{"mu", 3e3}, {"lambda_m", 1.6}}},
      {"saint-venant-kirchhoff", {{"young", 10e3}}},
      {"holzapfel-gasser-ogden", {{"c", 3e3}, {"k1", 4e3}, {"k2", 0.8}, {"kappa", 0.1}}, fibres}};
  for (fem::LawConstants& law : laws) law.values.emplace_back("poisson", poisson);
  return laws;
}

}  // namespace palpate::test
