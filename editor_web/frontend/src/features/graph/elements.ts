/** From a laid-out behavior to the canvas's nodes and edges; what is live is not in them. */
import { Position, type Edge, type Node } from '@xyflow/react'
import type { GraphNodeBody } from '../../api/types'
import { exitsOf, outcomeId, type Course, type Exit } from '../../document/layout'
import { flatten, isContainer, kindLabel } from '../../document/tree'
import type { LaidOut } from './useLayout'

export type StepNode = Node<{ node: GraphNodeBody; isInitial: boolean; machine: string; exits: readonly Exit[] }, 'leaf' | 'container'>
export type OutcomeNode = Node<{ machine: string; outcome: string }, 'outcome'>
export type CanvasNode = StepNode | OutcomeNode
export type CourseEdge = Edge<{ course: Course }, 'course'>

/** All nodes, parents before children. */
export function canvasNodes({ root, layout }: LaidOut): CanvasNode[] {
  return flatten(root).flatMap((node) => [step(node, root, layout), ...outcomes(node, layout)])
}

type Boxes = LaidOut['layout']

function step(node: GraphNodeBody, root: GraphNodeBody, layout: Boxes): StepNode {
  const parent = parentOf(node, root)
  const box = layout.boxes.get(node.path) ?? { x: 0, y: 0, ...layout.size }
  return {
    id: node.path,
    type: isContainer(node) ? 'container' : 'leaf',
    position: { x: box.x, y: box.y },
    width: box.width,
    height: box.height,
    data: {
      node,
      isInitial: parent?.initial === node.name,
      machine: parent?.path ?? '',
      exits: exitsOf(parent, node.name),
    },
    ...(parent ? { parentId: parent.path } : {}),
    ariaLabel: `${kindLabel(node.kind)} ${node.name}${node.title ? `, runs ${node.title}` : ''}`,
    sourcePosition: Position.Right,
    targetPosition: Position.Left,
  }
}

function outcomes(node: GraphNodeBody, layout: Boxes): OutcomeNode[] {
  if (node.kind !== 'machine') return []
  return node.outcomes.flatMap((outcome) => {
    const box = layout.boxes.get(outcomeId(node.path, outcome))
    if (!box) return []
    return [
      {
        id: outcomeId(node.path, outcome),
        type: 'outcome' as const,
        position: { x: box.x, y: box.y },
        width: box.width,
        height: box.height,
        parentId: node.path,
        selectable: false,
        focusable: false,
        data: { machine: node.path, outcome },
        sourcePosition: Position.Right,
        targetPosition: Position.Left,
      },
    ]
  })
}

function parentOf(node: GraphNodeBody, root: GraphNodeBody): GraphNodeBody | undefined {
  return flatten(root).find((candidate) => candidate.children.includes(node))
}

/** All arrows. */
export function canvasEdges({ layout }: LaidOut): CourseEdge[] {
  return layout.courses.map((course) => ({
    id: course.id,
    source: course.source,
    target: course.target,
    type: 'course',
    data: { course },
    focusable: false,
    selectable: false,
  }))
}
