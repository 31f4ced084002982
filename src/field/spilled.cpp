#include "field/spilled.h"

#include <algorithm>

namespace calot {

namespace {

LostState& account(std::vector<LostState>& lost, const std::string& body) {
  const std::string name = body.substr(0, body.find('.'));  // a piece's is its organ's with more
  auto at = std::find_if(lost.begin(), lost.end(), [&](const LostState& one) { return one.name == name; });
  return at == lost.end() ? lost.emplace_back(LostState{name}) : *at;
}

}  // namespace

void Spill::count(const std::string& body, Carries liquid, double volume) {
  LostState& of = account(lost, body);
  (liquid == Carries::blood ? of.blood : of.bile) += volume;
}

void Spill::count_aspirated(const std::string& body, double volume) {
  account(lost, body).aspirated += volume;
}

double Spill::lying(Carries liquid) const {
  double sum = 0;
  for (const Drop& drop : drops)
    if (drop.liquid == liquid) sum += drop.volume;
  for (const Film& film : films)
    for (const WetPoint& wet : film.wet) sum += wet.volume[static_cast<std::size_t>(liquid)];
  return sum;
}

}  // namespace calot
