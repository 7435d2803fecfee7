/** The graphs that the layout engine takes and gives back. */
import type { Point } from './geometry'

export interface ElkShape {
  id: string
  width?: number
  height?: number
  x?: number
  y?: number
  children?: ElkShape[]
  ports?: ElkShape[]
  edges?: ElkArrow[]
  layoutOptions?: Record<string, string>
}

export interface ElkArrow {
  id: string
  sources: string[]
  targets: string[]
  labels?: { text: string; width: number; height: number; x?: number; y?: number }[]
  sections?: { startPoint: Point; endPoint: Point; bendPoints?: Point[] }[]
}

/** Lays out one flat graph; elk's `layout`. */
export type LayoutCall = (graph: ElkShape) => Promise<ElkShape>
