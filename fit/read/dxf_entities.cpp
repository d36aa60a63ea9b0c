// SPDX-License-Identifier: MIT
//
// dxf_entities.cpp - dxflib's calls as entities in C.
#include "read/dxf_entities.h"

#include <dl_creationadapter.h>
#include <dl_dxf.h>

#include <sstream>
#include <string>
#include <vector>

namespace {

struct stopped {};

class lister : public DL_CreationAdapter {
  public:
    lister(bool (*add)(const narc_dxf_entity *, void *), void *context) : add_(add), context_(context) {}

    void addBlock(const DL_BlockData &d) override { put(NARC_DXF_BLOCK, {d.bpx, d.bpy}, d.name); }
    void endBlock() override { put(NARC_DXF_END_OF_BLOCK, {}); }
    void addLine(const DL_LineData &d) override { put(NARC_DXF_LINE, {d.x1, d.y1, d.x2, d.y2}); }
    void addArc(const DL_ArcData &d) override { put(NARC_DXF_ARC, {d.cx, d.cy, d.radius, d.angle1, d.angle2}); }
    void addCircle(const DL_CircleData &d) override { put(NARC_DXF_CIRCLE, {d.cx, d.cy, d.radius}); }
    void addEllipse(const DL_EllipseData &d) override {
        put(NARC_DXF_ELLIPSE, {d.cx, d.cy, d.mx, d.my, d.ratio, d.angle1, d.angle2});
    }
    void addInsert(const DL_InsertData &d) override {
        put(NARC_DXF_INSERT, {d.ipx, d.ipy, d.sx, d.sy, d.angle, double(d.cols), double(d.rows), d.colSp, d.rowSp},
            d.name);
    }
    void addPolyline(const DL_PolylineData &d) override { open(NARC_DXF_POLYLINE, {double(d.flags)}); }
    void addVertex(const DL_VertexData &d) override {
        if (held_)
            more_.insert(more_.end(), {d.x, d.y, d.bulge});
    }
    void addSpline(const DL_SplineData &d) override { open(NARC_DXF_SPLINE, {double(d.degree), double(d.flags), 0}); }
    void addKnot(const DL_KnotData &d) override { knots_.push_back(d.k); }
    void addControlPoint(const DL_ControlPointData &d) override { more_.insert(more_.end(), {d.x, d.y, d.w}); }
    void endEntity() override { close(); }

    void close() {
        if (!held_)
            return;
        held_ = false;
        if (entity_.kind == NARC_DXF_SPLINE)
            entity_.numbers[2] = double(knots_.size());
        more_.insert(more_.begin(), knots_.begin(), knots_.end());
        entity_.layer = layer_.c_str();
        entity_.name = name_.c_str();
        entity_.more = more_.data();
        entity_.more_count = more_.size();
        if (!add_(&entity_, context_))
            throw stopped{};
    }

  private:
    void open(narc_dxf_kind kind, std::vector<double> numbers, const std::string &name = "") {
        close();
        entity_ = narc_dxf_entity{};
        entity_.kind = kind;
        layer_ = getAttributes().getLayer();
        name_ = name;
        entity_.up = 1;
        if (getExtrusion())
            entity_.up = getExtrusion()->getDirection()[2];
        for (std::size_t k = 0; k < numbers.size(); k++)
            entity_.numbers[k] = numbers[k];
        more_.clear();
        knots_.clear();
        held_ = true;
    }

    void put(narc_dxf_kind kind, std::vector<double> numbers, const std::string &name = "") {
        open(kind, numbers, name);
        close();
    }

    bool (*add_)(const narc_dxf_entity *, void *);
    void *context_;
    narc_dxf_entity entity_{};
    std::string layer_, name_;
    std::vector<double> more_, knots_;
    bool held_ = false;
};

} // namespace

bool narc_list_dxf_entities(const char *text, size_t size, bool (*add)(const narc_dxf_entity *, void *),
                            void *context) {
    try {
        std::istringstream stream(std::string(text, size));
        DL_Dxf dxf;
        lister made(add, context);
        dxf.in(stream, &made);
        made.close();
    } catch (...) {
        return false;
    }
    return true;
}
