#pragma once
// Connective tissue between two organs of a field: strands (strand_join.h), what became of each, and their nodes.

#include "anatomy/definitions.h"
#include "body/tissue_body.h"
#include "joins/strand_join.h"
#include "organs/organ.h"

namespace calot {

/// All that moves of a tissue.
struct TissueMotion {
  BodyState state;  ///< of the strands' nodes
  std::vector<double>
      opened;  ///< the largest strain of each strand that took it beyond its strength; 0: none did
  std::vector<double> heated;  ///< J that each has taken from instruments' current
  std::vector<char> divided;   ///< of each: it was torn by current or by blades
  bool tearing = false;        ///< some strand was torn in the last step
};
void visit_members(auto&& visit, MembersOf<TissueMotion> auto& motion) {
  auto& [state, opened, heated, divided, tearing] = motion;
  visit(state, opened, heated, divided, tearing);
}

struct Tissue {
  TissueDefinition definition;
  std::shared_ptr<const TissueBody> body;
  /// What it is told of past and places (StrandJoin) it is told anew before each solve.
  std::shared_ptr<StrandJoin> strands;
  TissueMotion now;
  mutable ContactSearch search = {};  ///< finds nothing

  int torn() const;
  bool torn(std::size_t strand) const {
    return strands->strands()[strand].strand.law.torn(now.opened[strand]);
  }
  /// How many were torn by a pull: neither by current nor by blades.
  int torn_bluntly() const;
  /// Current or blades divide a strand.
  void divide(std::size_t strand);
  /// Of what divides a strand, 0 to 1: the heat that it has taken.
  double heated_share(std::size_t strand) const;
  /// The same between bodies that have other places in the group now.
  Tissue between(std::array<int, 2> bodies) const;
  /// `which` of its strands, increasing, as `strands` between two bodies; they move on as they do.
  Tissue part(std::array<int, 2> bodies, std::vector<PlacedStrand> strands_of,
              const std::vector<int>& which) const;
};

/// How thick the fat along a strand is, m: half of that of its lobules, as they are drawn and hide what lies behind.
double lobule_radius(const PlacedStrand& strand);

/// A strand as it lies now, m: its ends on the skins and its own node between them.
struct StrandLine {
  Vec3 from, by, to;
  Vec3 at(double share) const {
    return share < 0.5 ? Vec3(from + 2 * share * (by - from)) : Vec3(by + (2 * share - 1) * (to - by));
  }
};
/// Of all strands of a tissue, torn ones too.
std::vector<StrandLine> strand_lines(const Tissue& tissue, const std::vector<Organ>& organs);
/// N, of a strand that lies on such a line now.
double tension_of(const Tissue& tissue, std::size_t strand, const StrandLine& line);

/// Strands between two organs where they are now, slack as the definition has them, spread evenly over the place; each
/// stands for the area around it. Problems' paths begin at the tissue (".within"). Fails (scenario) where the two are
/// nowhere near enough, or the longest strand's break energy is too small.
Result<Tissue> make_tissue(const TissueDefinition& definition, const std::vector<Organ>& organs,
                           const Vec3& up);

}  // namespace calot
