#include "sim/spilled.h"

#include <algorithm>

namespace calot {

void Spill::count(const std::string& body, Carries liquid, double volume) {
  const std::string name = body.substr(0, body.find('.'));  // a piece's is its organ's with more
  auto at = std::find_if(lost.begin(), lost.end(), [&](const LostState& one) { return one.name == name; });
  if (at == lost.end()) at = lost.insert(lost.end(), LostState{name, 0, 0});
  (liquid == Carries::blood ? at->blood : at->bile) += volume;
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
