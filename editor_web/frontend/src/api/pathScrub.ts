/** Going along a planned path in the 3D view of this page, before anybody agrees to it; and turning its camera. */
import { pageStore } from './pageStore'

interface PathScrub {
  /** The arm whose path is scrubbed; empty for none. */
  readonly robot: string
  /** How far along the path, 0 to 1. */
  readonly share: number
}

const NONE: PathScrub = { robot: '', share: 0 }

export const usePathScrub = pageStore<PathScrub>(() => NONE)

/** Show the arm at this share of its path. */
export function scrubPath(robot: string, share: number): void {
  usePathScrub.setState({ robot, share })
}

/** Show the path as every page sees it. */
export function endScrub(): void {
  usePathScrub.setState(NONE)
}
