/** The names beside the bars of a timeline: each node with its kind, which no word beside it tells. */
import { screen } from '@testing-library/react'
import { expect, it } from 'vitest'
import { graphNode, show } from '../../../testing/page'
import { rowsOf } from '../../document/timeline'
import { Names } from './Names'

it('tells the kind of each node of the graph by an icon with a title', () => {
  const nodes = [
    graphNode('root', { kind: 'machine', title: '', icon: 'sitemap' }),
    graphNode('root/grasp', { title: 'gripper.Grasp', icon: 'gripper' }),
  ]
  const paths = ['root', 'root/grasp', 'root/unknown']
  const nothing = () => undefined
  show(
    <Names
      rows={rowsOf(paths, paths, new Set())}
      nodes={new Map(nodes.map((each) => [each.path, each]))}
      spans={new Map()}
      selected={undefined}
      cursorS={0}
      topPx={0}
      heightPx={400}
      onShow={nothing}
      onToggle={nothing}
    />,
  )
  expect(screen.getAllByRole('img').map((each) => each.getAttribute('data-icon'))).toEqual(['sitemap', 'gripper'])
  expect(screen.getByRole('treeitem', { name: 'State machine root' })).toBeVisible()
  expect(screen.getByRole('treeitem', { name: 'gripper.Grasp grasp' })).toBeVisible()
  expect(screen.getByRole('treeitem', { name: 'unknown' })).toBeVisible()
})
