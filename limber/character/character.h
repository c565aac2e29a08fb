// A character: a document, and what is read from it, each reading made when it is first asked for and kept.
#pragma once

#include <memory>
#include <string>

#include "limber/character/anatomy/skeleton_reading.h"
#include "limber/character/matching/body_skin.h"
#include "limber/document/rig/rig_io.h"

namespace limber {

// Immutable, cheap to copy (copies refer to the same readings), thread-safe. An error of a reading is thrown every time
// it is requested.
class Character {
 public:
  explicit Character(std::shared_ptr<const Asset> document);
  // Implicit, as the next: a document is a character of which nothing is read yet.
  Character(Asset&& document);
  // Of a document that outlives the character. Clips may be added to it at any time; its nodes, skins and vertices stay
  // as they are until the last reading is made.
  Character(const Asset& document);

  const Asset& document() const;

  // Does the document have a skin?
  bool hasRig() const;

  // readSkeleton: the joints of the skins, in bind pose. Throws Error as it does.
  const AssetSkeleton& binding() const;
  // animatedSkeleton: the same, or of a document without a skin the nodes that move. Throws Error as it does.
  const AssetSkeleton& moving() const;
  // The skeleton of moving(), and what is read from it at rest.
  const SkeletonReading& reading() const;
  const Skeleton& skeleton() const { return moving().skeleton; }
  const Anatomy& anatomy() const { return reading().anatomy(); }

  // collectGeometry: all primitives of the scene in world space, in bind pose. Throws Error as it does.
  const Geometry& surface() const;
  // shapedGeometry: the same with blend shapes as the nodes have them. Throws Error as it does.
  const Geometry& shapedSurface() const;
  // readWeights: #S rows over binding(). Throws Error as the two do.
  const SkinWeights& weights() const;
  // The same surface for whoever keeps it.
  std::shared_ptr<const Geometry> sharedSurface() const;
  // How thick the body is about its bones (makeBodySkin).
  const std::shared_ptr<const BodySkin>& skin() const;

  // The character with all skins bound in one pose (withJoinedBinds); this one where they are. What is read from it
  // lives as long as this one. Throws Error as withJoinedBinds does.
  Character inOneBindPose() const;

  // The character of a document that differs from this one's in names alone: with the surface and the weights that were
  // read.
  Character renamed(Asset document) const;

 private:
  struct Readings;
  std::shared_ptr<const Readings> readings_;
};

}  // namespace limber
