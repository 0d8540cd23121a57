// The iso-surface by VTK.
#pragma once
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>

#include "engine/base/mesh_arrays.h"
#include "perf/peers/peer.h"

namespace peer {

// Of a copy of the volume, mm. The caller keeps a reference for as long as it is used.
inline vtkSmartPointer<vtkImageData> vtk_image(const Volume& volume) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(volume.dims.data());
  image->SetSpacing(volume.spacing[0], volume.spacing[1], volume.spacing[2]);
  image->AllocateScalars(VTK_FLOAT, 1);
  std::copy(volume.values.begin(), volume.values.end(),
            static_cast<float*>(image->GetScalarPointer()));
  return image;
}

inline vtkSmartPointer<vtkPolyData> flying_edges(vtkImageData* image, double iso) {
  const vtkNew<vtkFlyingEdges3D> filter;
  filter->SetInputData(image);
  filter->SetValue(0, iso);
  filter->ComputeNormalsOff();
  filter->ComputeScalarsOff();
  filter->Update();
  return filter->GetOutput();
}

// Of a surface of triangles: its corners, three coordinates each, and its faces.
inline void arrays_of(vtkPolyData* surface, std::vector<double>& xyz, std::vector<uint32_t>& abc) {
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i) {
    const double* p = surface->GetPoint(i);
    xyz.insert(xyz.end(), p, p + 3);
  }
  for (vtkIdType f = 0; f < surface->GetNumberOfCells(); ++f) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    surface->GetCellPoints(f, count, ids);
    for (size_t k = 0; k < 3; ++k) abc.push_back(static_cast<uint32_t>(ids[k]));
  }
}

}  // namespace peer
