/** The scene of the cell as a file for other programs. */
import { getFile } from './client'

export type SceneFormat = 'glb' | 'xml' | 'urdf'

export const sceneFile = (format: SceneFormat): Promise<Blob> => getFile(`/cell/scene?format=${format}`)
