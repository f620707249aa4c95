#pragma once

#include <span>
#include <vector>

#include "forces/contact_force.h"
#include "forces/spring_force.h"
#include "model/adjacency.h"
#include "model/vectors.h"

namespace percale {

/// The step matrix A = M - dt Jv - dt^2 Jq, kg: symmetric 3x3 blocks in the pattern of the springs, fixed once and refilled in
/// place, plus contact rows kept apart. A block between two vertices is -(a I + w w^T).
struct BlockMatrix {
    const Adjacency* pattern = nullptr;
    std::vector<double> a, wx, wy, wz;  // one an entry of the pattern
    DiagonalBlocks diagonal;            // mass and springs
    DiagonalBlocks inverse;             // of the whole diagonal blocks, contact included: block Jacobi
    std::vector<double> free;           // 1, or 0 for a vertex whose motion is prescribed; padding counts as prescribed
    std::span<const ContactBlock> contacts;
};

/// Sizes the matrix for a pattern.
void set_pattern(const Adjacency& pattern, BlockMatrix& matrix);

/// Diagonal blocks of mass (kg, one a vertex; 1 kg for padding) and springs.
void fill_diagonal(std::span<const double> mass, const Adjacency& pattern, const SpringTerms& springs, DiagonalBlocks& diagonal);

/// Fills in mass (kg, one a vertex) and springs.
void fill_matrix(std::span<const double> mass, const SpringTerms& springs, BlockMatrix& matrix);

/// Inverts the diagonal blocks with contacts. Contacts are viewed, not copied.
void set_contacts(std::span<const ContactBlock> contacts, BlockMatrix& matrix);

/// y = A x; rows of prescribed vertices included.
void multiply(const BlockMatrix& matrix, const Vectors& x, Vectors& y);

/// z = D^-1 r for free vertices, 0 for the others (D: block diagonal).
void precondition(const BlockMatrix& matrix, const Vectors& r, Vectors& z);

/// x = 0 at prescribed vertices.
void filter(const BlockMatrix& matrix, Vectors& x);

}  // namespace percale
