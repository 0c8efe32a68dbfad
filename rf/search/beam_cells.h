// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Which facets does a beam meet? Warnock's subdivision of its cross-section: a cell is cut in two until it is settled
// which facets may be met in it. A facet leaves a cell only by proof.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/search/beam_view.h"

namespace greatx::rf {

/// What a beam was found to meet: a facet behind at least `walls` more walls than the beam itself, and where on it.
struct BeamHit {
  uint32_t facet = 0;  ///< BeamScene's
  uint32_t walls = 0;
  double min_a = 0.0, max_a = 0.0, min_b = 0.0,
         max_b = 0.0;  ///< on the facet (BeamFacet::axis_a, axis_b), metres
};

struct BeamCellOptions {
  uint32_t walls = 0;        ///< that may be passed on the way to a facet
  bool tight = true;         ///< rectangles on facets are worth some cells: their beams will be followed
  bool edge_strips = false;  ///< BeamSearchOptions::edge_strips
  uint32_t transparent_body = ~0u;  ///< facets of this body hide nothing
  uint32_t most_cells = 1u << 16;   ///< beyond, everything left is taken
};

class BeamCells {
 public:
  /// All facets and wedges that the beam of `view` may meet. `hits`: by facet, then walls; `wedges`: indices in the
  /// list of wedges, ascending, each once. Both are appended to.
  void settle(const BeamView& view, const BeamCellOptions& options, std::vector<BeamHit>& hits,
              std::vector<uint32_t>& wedges);
  uint64_t cells() const { return cells_; }  ///< looked at since the start

 private:
  enum Presence : uint8_t { absent, present, unknown };
  /// A facet in a cell.
  struct Entry {
    uint32_t facet = 0;  ///< of the view
    uint32_t first_edge = 0,
             edge_count = 0;      ///< into the list of edges beside: those that may touch the cell
    uint8_t at_sample = unknown;  ///< is the sample's ray inside its outline?
    bool stops = false;           ///< wherever it is in the cell, it stops rays: they start well before it
    bool covers = false;          ///< all of the cell, and stops
    bool gone = false;
    uint8_t walls = 0;  ///< proven to be passed before it
  };
  struct Cell {
    SlopeRect rect;
    double sample_a = 0.0, sample_b = 0.0;
    uint32_t first_entry = 0, entry_count = 0;
  };
  struct Lists {  ///< of one generation of cells
    std::vector<Cell> cells;
    std::vector<Entry> entries;
    std::vector<uint32_t> edges;
    void clear() { cells.clear(), entries.clear(), edges.clear(); }
  };
  /// The cell being looked at.
  struct Here {
    SlopeRect rect;
    double a, b, half_a, half_b;  ///< centre, and half of the sides with room for roundings
    double sample_a, sample_b;
  };
  struct Surface {                  ///< one or more facets that cover the cell together
    uint32_t first = 0, count = 0;  ///< into members_
    double inverse_depth = 0.0;     ///< at the sample
    bool opaque = false;
  };
  struct Target {  ///< what is known of a facet of the view with a number of walls before it
    bool seen = false, used = false;
    uint32_t tries = 0;  ///< small cells that it was in without being seen
    double min_a = 1e300, max_a = -1e300, min_b = 1e300, max_b = -1e300;
  };

  void begin();
  void look_at(const SlopeRect& rect, const Cell* parent);
  void inherit(const Entry& from, std::span<const uint32_t> edges, const Cell* parent);
  void choose_sample();
  bool find_presence(const Cell* parent);
  void find_surfaces();
  void grow_shell(uint32_t start);
  void drop_hidden();
  bool in_front(const ViewFacet& cover, const ViewFacet& facet, double room) const;
  bool apart(const ViewFacet& first, const ViewFacet& second) const;
  bool hidden_at_contact(const Entry& entry) const;
  struct Pencil;
  bool hidden_around(const Entry& entry, const Pencil& pencil) const;
  void mark_seen();
  void find_wedges();
  bool settled();
  bool fine(const ViewFacet& facet, double parts) const;
  void take();
  void keep();
  void report(std::vector<BeamHit>& hits, std::vector<uint32_t>& wedges) const;
  bool project(const ViewFacet& facet, BeamHit& window) const;
  const ViewFacet& facet_of(const Entry& entry) const { return view_->facets()[entry.facet]; }
  std::span<const uint32_t> edges_of(const Entry& entry) const {
    return std::span(edges_).subspan(entry.first_edge, entry.edge_count);
  }
  double half_range(const ViewFacet& facet) const;
  bool touches(const ViewEdge& edge) const;
  bool near_sample(const ViewEdge& edge) const;
  Target& target(const Entry& entry) { return targets_[entry.facet * (options_.walls + 1) + entry.walls]; }
  const Target& target(const Entry& entry) const {
    return targets_[entry.facet * (options_.walls + 1) + entry.walls];
  }

  const BeamView* view_ = nullptr;
  BeamCellOptions options_;
  Here here_{};
  Lists now_, next_;
  std::vector<Entry> entries_;  ///< of the cell being looked at
  std::vector<uint32_t> edges_;
  std::vector<Surface> surfaces_;
  std::vector<uint32_t> members_;  ///< indices into entries_
  std::vector<uint8_t> visited_;
  std::vector<Target> targets_;  ///< [facets of the view][walls + 1]
  std::vector<uint8_t> done_;    ///< [facets of the view]: wedges that need no more looking
  uint64_t cells_ = 0, cells_before_ = 0;
};

}  // namespace greatx::rf
