#include "group/friction_load.h"

#include <algorithm>
#include <tuple>

namespace calot {

const RubbingPoint* FrictionLoad::find(int shape, int point) const {
  const auto at = std::lower_bound(points.begin(), points.end(), std::tie(shape, point),
                                   [](const RubbingPoint& rubbing, const std::tuple<int, int>& key) {
                                     return std::tie(rubbing.shape, rubbing.point) < key;
                                   });
  return at != points.end() && at->shape == shape && at->point == point ? &*at : nullptr;
}

double FrictionLoad::value(const Tessellation& skin, const VecX& x) const {
  ContactPlaces places(skin, x);
  double sum = 0;
  for (const RubbingPoint& rubbing : points) sum += rubbing.hold.sample(places.at(rubbing.point)).energy;
  return sum;
}

void FrictionLoad::add_gradient(const Tessellation& skin, const VecX& x, VecX& gradient) const {
  ContactPlaces places(skin, x);
  ContactLoad load(skin, gradient);
  for (const RubbingPoint& rubbing : points)
    load.add(rubbing.point, rubbing.hold.sample(places.at(rubbing.point)).gradient);
  load.finish();
}

void FrictionLoad::add_hessian(const Tessellation& skin, const VecX& x, BlockMatrix& matrix,
                               Workers* workers) const {
  ContactPlaces places(skin, x);
  ContactStiffness stiffness(skin, matrix, workers);
  for (const RubbingPoint& rubbing : points)
    stiffness.add(rubbing.point, rubbing.hold.sample(places.at(rubbing.point)).hessian);
  stiffness.finish();
}

}  // namespace calot
