import { expect, it } from 'vitest'
import type { CanvasNode } from './elements'
import { anchorId, draggedFrames, isInside, withAnchors } from './frameDrag'
import { nodeBoxes } from './nodeBoxes'

const SIZE = { width: 10, height: 10 }
const frame = (id: string, x: number, parentId?: string) =>
  ({
    id,
    type: 'frame',
    position: { x, y: 0 },
    ...SIZE,
    data: {},
    ...(parentId === undefined ? {} : { parentId }),
  }) as unknown as CanvasNode

const NODES = [frame('root/a', 100), frame('root/b', 300), frame('root/a/in', 20, 'root/a'), frame('root/a/in/deep', 5, 'root/a/in')]

function moved(nodes: readonly CanvasNode[], id: string, x: number): CanvasNode[] {
  return nodes.map((node) => (node.id === id ? { ...node, position: { ...node.position, x } } : node))
}

it('hangs only what is directly in the dragged container on its anchor', () => {
  const drawn = withAnchors(NODES, draggedFrames(NODES.slice(0, 1)))
  expect(drawn.map(({ id, parentId }) => [id, parentId])).toEqual([
    ['root/a', undefined],
    [anchorId('root/a'), undefined],
    ['root/b', undefined],
    ['root/a/in', anchorId('root/a')],
    ['root/a/in/deep', 'root/a/in'],
  ])
})

it('gives the same objects for each frame of the drag, but for the container itself', () => {
  const frames = draggedFrames(NODES.slice(0, 1))
  const [before, after] = [withAnchors(NODES, frames), withAnchors(moved(NODES, 'root/a', 150), frames)]
  expect(after.filter((node, index) => node !== before[index]).map((node) => node.id)).toEqual(['root/a'])
})

it('knows where what is in the dragged container is drawn', () => {
  const frames = draggedFrames(NODES.slice(0, 1))
  const boxes = nodeBoxes(withAnchors(moved(NODES, 'root/a', 150), frames))
  expect(['root/a', 'root/a/in', 'root/a/in/deep', 'root/b'].map((id) => boxes.get(id)?.x)).toEqual([150, 170, 175, 300])
})

it('knows by their ids which nodes and arrows are in a container', () => {
  const ids = ['root/a/in', 'root/a#done', 'root/a|in|done', 'root/a/in|deep|done', 'root/a', 'root/ab', 'root/ab/in', 'root|a|done']
  expect(ids.filter((id) => isInside(id, 'root/a'))).toEqual(ids.slice(0, 4))
})
