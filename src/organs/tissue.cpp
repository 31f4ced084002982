#include "organs/tissue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "organs/strand_places.h"

namespace calot {
namespace {

/// What strands are stretched over at least, m: skins that nearly touch hang together by more than their gap.
constexpr double least_length = 1e-3;

StrandLaw::Setup law_of(const TissueDefinition& definition, const StrandPlace& place) {
  StrandLaw::Setup out;
  const double slack = (1 + definition.slack) * place.gap;
  out.length = std::max(slack, least_length);
  out.taut = place.way - place.gap + slack;
  out.stiffness = definition.stiffness * place.area;
  out.stiffening = definition.stiffening;
  out.strength = definition.strength * place.area;
  out.break_energy = definition.break_energy * place.area;
  return out;
}

/// The body of the strands' own nodes: each node halfway between its strand's ends, with the strand's mass, kg.
std::shared_ptr<const TissueBody> nodes_of(const TissueDefinition& definition,
                                           const std::vector<StrandPlace>& places, const Vec3& up) {
  TissueBody::Setup setup;
  setup.name = definition.name;
  setup.up = up;
  setup.strength = 0;
  for (const StrandPlace& place : places) {
    const StrandLaw::Setup law = law_of(definition, place);
    setup.strength = std::max(setup.strength, law.strength);
    setup.nodes.push_back(0.5 * (place.from + place.to));
    setup.masses.push_back(definition.density * place.area * law.length);
  }
  return std::make_shared<const TissueBody>(setup);
}

/// Fails (scenario) where a strand of the tissue's strength takes more to tear, J/m^2, than the tissue's break energy.
std::optional<Failure> check_break_energy(const TissueDefinition& definition,
                                          const std::vector<StrandPlace>& places) {
  double least = 0, longest = 0;
  for (const StrandPlace& place : places) {
    const StrandLaw::Setup law = law_of(definition, place);
    least = std::max(least, StrandLaw::least_break_energy(law) / place.area);
    longest = std::max(longest, law.length);
  }
  if (!(least > definition.break_energy)) return std::nullopt;
  return fail(
      FailureKind::scenario,
      fmt::format("strands of '{}' are up to {:.3g} mm long: of this strength they take {:.3g} J/m^2 or "
                  "more to tear, not {:.3g}",
                  definition.name, 1e3 * longest, least, definition.break_energy),
      "raise break_energy, or lower strength or within", {"", 0, ".break_energy"});
}

}  // namespace

int Tissue::torn() const {
  int count = 0;
  for (std::size_t i = 0; i < now.opened.size(); ++i) count += torn(i) ? 1 : 0;
  return count;
}

int Tissue::torn_bluntly() const {
  int count = 0;
  for (std::size_t i = 0; i < now.opened.size(); ++i) count += torn(i) && !now.divided[i] ? 1 : 0;
  return count;
}

void Tissue::divide(std::size_t strand) {
  const StrandLaw& law = strands->strands()[strand].strand.law;
  now.opened[strand] = std::max(now.opened[strand], law.peak() + law.tail());
  now.divided[strand] = 1;
}

double Tissue::heated_share(std::size_t strand) const {
  return std::min(1.0, now.heated[strand] / (definition.divide_energy * strands->strands()[strand].area));
}

Tissue Tissue::between(std::array<int, 2> bodies) const {
  Tissue out = *this;
  out.strands = std::make_shared<StrandJoin>(bodies, strands->strands());
  return out;
}

Tissue Tissue::part(std::array<int, 2> bodies, std::vector<PlacedStrand> strands_of,
                    const std::vector<int>& which) const {
  Tissue out = *this;
  out.strands = std::make_shared<StrandJoin>(bodies, std::move(strands_of));
  out.body = std::make_shared<const TissueBody>(body->part(which));
  const auto taken = [&](const VecX& all) {
    VecX some(all.size() == 0 ? 0 : 3 * static_cast<Eigen::Index>(which.size()));
    for (Eigen::Index i = 0; i < some.size(); i += 3)
      some.segment<3>(i) = all.segment<3>(3 * Eigen::Index{which[static_cast<std::size_t>(i / 3)]});
    return some;
  };
  out.now.state.x = taken(now.state.x);
  out.now.state.motion.begin.x = taken(now.state.motion.begin.x);
  out.now.state.motion.begin.velocity = taken(now.state.motion.begin.velocity);
  out.now.opened.clear();
  out.now.heated.clear();
  out.now.divided.clear();
  for (int strand : which) {
    out.now.opened.push_back(now.opened[strand]);
    out.now.heated.push_back(now.heated[strand]);
    out.now.divided.push_back(now.divided[strand]);
  }
  return out;
}

double lobule_radius(const PlacedStrand& strand) {
  constexpr double thinnest = 1.1e-3, thickest = 2.8e-3;
  return std::clamp(0.6 * std::sqrt(strand.area), thinnest, thickest);
}

std::vector<StrandLine> strand_lines(const Tissue& tissue, const std::vector<Organ>& organs) {
  // The few points that carry strands: a gallbladder's skin has 30 thousand.
  const auto on_skin = [&](const CarriedPlace& place, std::size_t side) {
    const Organ& organ = organs[static_cast<std::size_t>(tissue.strands->bodies()[side])];
    Vec3 out = Vec3::Zero();
    for (std::size_t i = 0; i < place.points.size(); ++i)
      out += place.weights[i] * organ.body->skin_point(place.points[i], organ.state.x);
    return out;
  };
  std::vector<StrandLine> out;
  for (const PlacedStrand& strand : tissue.strands->strands())
    out.push_back({on_skin(strand.one, 0),
                   tissue.now.state.x.segment<3>(3 * static_cast<Eigen::Index>(out.size())),
                   on_skin(strand.other, 1)});
  return out;
}

double tension_of(const Tissue& tissue, std::size_t strand, const StrandLine& line) {
  StrandVector places;
  places << line.from, line.by, line.to;
  return tissue.strands->strands()[strand].strand.tension(places, {tissue.now.opened[strand], 0});
}

Result<Tissue> make_tissue(const TissueDefinition& definition, const std::vector<Organ>& organs,
                           const Vec3& up) {
  const auto named = [&](const std::string& name) {  // both are known to be there
    return static_cast<int>(std::find_if(organs.begin(), organs.end(),
                                         [&](const Organ& organ) { return organ.definition.name == name; }) -
                            organs.begin());
  };
  const std::array<int, 2> bodies{named(definition.from), named(definition.to)};
  const Result<std::vector<StrandPlace>> places =
      strand_places(definition, organs[bodies[0]], organs[bodies[1]]);
  if (!places) return places.failure();
  if (std::optional<Failure> failure = check_break_energy(definition, places.value())) return *failure;
  std::vector<PlacedStrand> strands;
  for (const StrandPlace& place : places.value()) {
    Result<StrandLaw> law = StrandLaw::create(law_of(definition, place));
    if (!law) return law.failure();
    const StrandThread thread = strand_thread(law.value(), definition.radius);
    strands.push_back({{std::move(law).value()}, place.one, place.other, thread, place.area});
  }
  Tissue out;
  out.definition = definition;
  out.body = nodes_of(definition, places.value(), up);
  out.now.state.x = out.body->rest();
  out.now.opened.assign(strands.size(), 0.0);
  out.now.heated.assign(strands.size(), 0.0);
  out.now.divided.assign(strands.size(), 0);
  out.strands = std::make_shared<StrandJoin>(bodies, std::move(strands));
  out.search.own.active = false;
  return out;
}

}  // namespace calot
