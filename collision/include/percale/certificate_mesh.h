#pragma once

#include <memory>
#include <string>

#include "percale/mesh.h"

namespace percale {

/// A mesh prepared for certificates: its tree of boxes, and whether it is closed. Kept from certificate to certificate, a body
/// that stands still costs nothing, and one that moves no new tree. World coordinates, m.
class CertificateMesh {
public:
    /// Throws SceneError for a mesh that certify refuses; `name` stands in the message.
    explicit CertificateMesh(const TriangleMesh& mesh, const std::string& name = "certificate");
    CertificateMesh(CertificateMesh&&) noexcept;
    CertificateMesh& operator=(CertificateMesh&&) noexcept;
    ~CertificateMesh();

    /// Takes this mesh instead. Where it has the same triangles the tree is kept and its boxes are fitted anew. False if all
    /// coordinates are the same, too: then nothing happened. Throws as the constructor, and is then as before. Not to be called
    /// while another thread reads.
    bool move(const TriangleMesh& mesh);

    struct Prepared;
    const Prepared& prepared() const { return *prepared_; }

private:
    std::unique_ptr<Prepared> prepared_;
};

}  // namespace percale
