#pragma once
// The strands of a tissue (fem/strand.h), each from a place on one body by way of its own node, a third body's
// (tissue_body.h), to a place on another. Instruments meet it on its way (strand_touch.h).
//
// Neighbours are coupled by the skins that they end on, not by their nodes: these then are condensed one by one, where a
// sheet of linked nodes takes several times as long.

#include "fem/strand.h"
#include "group/join.h"
#include "joins/carried_place.h"
#include "joins/strand_touch.h"

namespace calot {

/// A strand and the places of its ends.
struct PlacedStrand {
  Strand strand;
  CarriedPlace one, other;
  StrandThread thread = {};
  double area = 0;  ///< m^2 that it stands for
};
void visit_members(auto&& visit, MembersOf<PlacedStrand> auto& placed) {
  auto& [strand, one, other, thread, area] = placed;
  visit(strand, one, other, thread, area);
}

class StrandJoin : public Join {
 public:
  /// `bodies`: places in the group of the two that it ends on.
  StrandJoin(std::array<int, 2> bodies, std::vector<PlacedStrand> strands);
  StrandJoin(const StrandJoin&) = delete;
  StrandJoin& operator=(const StrandJoin&) = delete;

  /// The place in the group of the body whose nodes the strands have, in their order.
  void set_nodes(int body) { nodes_body_ = body; }

  /// What the strands bring into the solves that follow: how far each has been opened, and the time that passes, s
  /// (0: none).
  void set_past(const std::vector<double>& opened, double duration);
  /// What they meet in the solves that follow; what is torn meets nothing.
  void set_touch(StrandTouch touch) { touch_ = std::move(touch); }

  void begin(std::span<const GroupPlace> bodies) const override;
  double value(const VecX& x) const override;
  void add_gradient(const VecX& x, VecX& gradient) const override;
  void add_hessian(const VecX& x, BlockMatrix& matrix) const override;
  bool add_convexity(const VecX& x, BlockMatrix& matrix) const override;
  void add_cliques(const VecX& x, bool close, std::vector<std::vector<int>>& cliques) const override;

  std::size_t lasting_cliques() const override { return active() ? strands_.size() : 0; }
  void relax(const LooseNodes& nodes, VecX& x) const override;

  /// No step takes a strand through what it touches.
  double safe_share(const VecX& x, const VecX& step, double share) const override;

  const std::array<int, 2>& bodies() const { return bodies_; }
  const std::vector<PlacedStrand>& strands() const { return strands_; }
  /// Strain of each at x, in the group's numbering.
  std::vector<double> strains(const VecX& x) const;
  /// N, of all strands on the first body.
  Vec3 force(const VecX& x) const;

  // What follows needs to know where the bodies are: begin().
  bool active() const { return rows_.rows() > 0; }
  /// Of a, m and b, m, or how they move.
  StrandVector places(std::size_t strand, const VecX& x) const;
  /// Adds a force on a place between two of these, at this share of the piece's way, N, to the nodes.
  void add_force(std::size_t strand, int piece, double share, const Vec3& force, VecX& nodes) const;
  bool torn(std::size_t strand) const { return strands_[strand].strand.law.torn(pasts_[strand].opened); }
  /// Calls use(strand, contact) for what meets the strands at x.
  template <class Use>
  void for_contacts(const VecX& x, const Use& use) const {
    std::vector<StrandContact> found;
    for (std::size_t i = 0; meets() && i < strands_.size(); ++i) {
      if (torn(i)) continue;
      found.clear();
      touch_.find(strands_[i].thread, places(i, x), found);
      for (const StrandContact& contact : found) use(i, contact);
    }
  }
  const StrandTouch& touch() const { return touch_; }

 private:
  /// Rows of a strand, of increasing nodes.
  std::array<int, 3> ordered_rows(std::size_t strand) const;
  void find_blocks(const BlockMatrix& matrix) const;
  /// Adds a matrix of each strand's places to those of its nodes: of(strand, places, matrix) says which, and whether
  /// there is one. Whether any was added.
  template <class Of>
  bool add_matrices(const VecX& x, BlockMatrix& matrix, const Of& of) const;
  bool meets() const { return active() && !touch_.none(); }
  /// Null: it meets nothing.
  const StrandThread* thread(std::size_t strand) const {
    return touch_.none() || torn(strand) ? nullptr : &strands_[strand].thread;
  }

  std::array<int, 2> bodies_;
  int nodes_body_ = -1;
  std::vector<PlacedStrand> strands_;
  std::vector<StrandPast> pasts_;
  StrandTouch touch_;
  /// Three rows a strand, for a, m and b, in the group's numbering; none where a body is not in the group.
  mutable StencilTable rows_;
  /// What they were made for.
  mutable std::array<int, 3> first_{-1, -1, -1};
  mutable std::array<std::vector<int>, 2> details_;
  /// Where the blocks of each strand's nodes are in a matrix: of each column those below it.
  struct Blocks {
    BlockMatrix pattern{0, {}};
    std::vector<int> slots;
  };
  mutable Blocks blocks_;
};

}  // namespace calot
