/** Planned paths in words: what a run that asks has planned, and which arms wait for a free path. Pure. */
import { lookup, type Dict } from './dict'
import { requestsOf } from './runState'
import type { ControlView, GateWait, NodeLive, PlanLive, RobotLive, PathLive } from '../api/types'
import { duration } from './time'

/** The paths that a node, or what lies inside it, has planned. */
export function plansOf(nodes: Dict<NodeLive>, path: string): readonly PlanLive[] {
  const inside = `${path}/`
  return Object.entries(nodes).flatMap(([at, node]) => (node.plan && (at === path || at.startsWith(inside)) ? [node.plan] : []))
}

/** `3.20 s for 1.24 m of the tool's path, found by RRTConnect in 0.12 s`. */
export function planWords(plan: PlanLive): string {
  return `${duration(plan.duration_s)} for ${plan.length_m.toFixed(2)} m of the tool's path, found by ${plan.found_by} in ${duration(plan.planning_s)}`
}

/** Is the path that is shown for this arm one that nobody follows yet? */
export function isProposed(robot: RobotLive | undefined): boolean {
  return robot?.path?.state === 'proposed'
}

/** The first question that is about paths which the 3D view shows. */
export function proposedRequest(control: ControlView | null, nodes: Dict<NodeLive>, robots: Dict<RobotLive>): GateWait | undefined {
  return requestsOf(control).find(({ path }) => plansOf(nodes, path).some((plan) => isProposed(lookup(robots, plan.robot))))
}

export interface BlockedPath {
  readonly robot: string
  readonly path: PathLive
}

/** The arms whose path is blocked, by name. */
export function blockedPaths(robots: Dict<RobotLive>): readonly BlockedPath[] {
  return Object.values(robots)
    .flatMap(({ name, path }) => (path?.state === 'blocked' ? [{ robot: name, path }] : []))
    .toSorted((a, b) => a.robot.localeCompare(b.robot))
}

/** `12 s`, `3:05 min`. */
export function sinceWords(seconds: number): string {
  return seconds < 60 ? `${Math.max(0, Math.floor(seconds))} s` : duration(seconds)
}
