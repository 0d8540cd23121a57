// An image out of a file that has been dropped: {name, dims, voxels, spacing, origin, direction, notes}, in
// LPS and mm as plc_image has it; notes are lines that the user should know, or undefined.
import { bytesOf } from './bytes.js';
import { refuse } from './failure.js';
import { isNifti, readNifti } from './nifti.js';
import { isNrrd, readNrrd } from './nrrd.js';

const HEAD = 540;  // bytes, the longest header whose kind is asked for

export async function readImage(file) {
  const bytes = await bytesOf(file);
  const head = await bytes.peek(HEAD);
  if (isNrrd(head)) return readNrrd(file, (begin, packed) => bytesOf(file, { begin, packed }));
  if (isNifti(head)) return readNifti(file.name, head, bytes);
  return refuse(`${file.name}: is neither NIfTI (.nii, .nii.gz) nor NRRD (.nrrd)`);
}
