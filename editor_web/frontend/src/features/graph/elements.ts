/** From a laid-out behavior to the canvas's nodes and edges; what is live is not in them. */
import { Position, type Edge, type Node } from '@xyflow/react'
import type { GraphNode } from '../../api/types'
import { disabledText } from '../../document/editing/disabling'
import type { Size } from '../../document/geometry'
import { outcomeId } from '../../document/edgeId'
import { exitsOf, type Course, type Exit } from '../../document/layout'
import { flatten, isContainer, kindLabel } from '../../document/tree'
import type { LaidOut } from './useLayout'

export type StepNode = Node<
  { node: GraphNode; isInitial: boolean; isPassedOver: boolean; isFolded: boolean; machine: string; exits: readonly Exit[] },
  'leaf' | 'container'
>
export type OutcomeNode = Node<{ machine: string; outcome: string }, 'outcome'>
export type CanvasNode = StepNode | OutcomeNode
export type CourseEdge = Edge<{ course: Course }, 'course'>

/** All nodes, parents before children. */
export function canvasNodes({ root, whole, layout }: LaidOut): CanvasNode[] {
  const all = flatten(root)
  const containers = new Set(
    root === whole
      ? []
      : flatten(whole)
          .filter(isContainer)
          .map((node) => node.path),
  )
  const parents = new Map(all.flatMap((node) => node.children.map((child) => [child, node] as const)))
  const passedOver = new Set<GraphNode>()
  for (const node of all) {
    const parent = parents.get(node)
    if (node.disabled !== false || (parent && passedOver.has(parent))) passedOver.add(node)
  }
  return all.flatMap((node) => [
    step(node, parents.get(node), layout, {
      isPassedOver: passedOver.has(node),
      isFolded: !isContainer(node) && containers.has(node.path),
    }),
    ...outcomes(node, layout),
  ])
}

type Boxes = LaidOut['layout']

/** Said beforehand, so that the canvas need not look at each node that it draws. */
function measured({ width, height }: Size): Pick<CanvasNode, 'width' | 'height' | 'measured' | 'handles'> {
  const port = { y: height / 2, width: 1, height: 1 }
  return {
    width,
    height,
    measured: { width, height },
    handles: [
      { ...port, type: 'target', position: Position.Left, x: 0 },
      { ...port, type: 'source', position: Position.Right, x: width - 1 },
    ],
  }
}

function step(
  node: GraphNode,
  parent: GraphNode | undefined,
  layout: Boxes,
  drawn: Pick<StepNode['data'], 'isPassedOver' | 'isFolded'>,
): StepNode {
  const box = layout.boxes.get(node.path) ?? { x: 0, y: 0, ...layout.size }
  return {
    id: node.path,
    type: isContainer(node) ? 'container' : 'leaf',
    position: { x: box.x, y: box.y },
    ...measured(box),
    data: {
      node,
      isInitial: parent?.initial === node.name,
      ...drawn,
      machine: parent?.path ?? '',
      exits: exitsOf(parent, node.name),
    },
    ...(parent ? { parentId: parent.path } : {}),
    ariaLabel: `${kindLabel(node.kind)} ${node.name}${drawn.isFolded ? ', collapsed' : ''}${node.disabled === false ? '' : `, ${disabledText(node.disabled)}`}${node.title && !drawn.isFolded ? `, runs ${node.title}` : ''}`,
    sourcePosition: Position.Right,
    targetPosition: Position.Left,
  }
}

function outcomes(node: GraphNode, layout: Boxes): OutcomeNode[] {
  if (node.kind !== 'machine') return []
  return node.outcomes.flatMap((outcome) => {
    const box = layout.boxes.get(outcomeId(node.path, outcome))
    if (!box) return []
    return [
      {
        id: outcomeId(node.path, outcome),
        type: 'outcome' as const,
        position: { x: box.x, y: box.y },
        ...measured(box),
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
