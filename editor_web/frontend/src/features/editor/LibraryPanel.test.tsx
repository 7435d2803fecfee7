/** The library shows everything that can be put into a behavior, each with the icon that its node will have. */
import { screen } from '@testing-library/react'
import { expect, it } from 'vitest'
import { live, show } from '../../../testing/page'
import type { CatalogueBody } from '../../api/types'
import { LibraryPanel } from './LibraryPanel'
import { blank, setEditor, useEditor } from './store'

const CATALOGUE = {
  states: [{ name: 'gripper.Grasp', group: 'gripper', icon: 'gripper', doc: '', outcomes: [], parameters: [] }],
  containers: [{ kind: 'machine', title: 'State machine', icon: 'sitemap', doc: '', only_in_tree: false, form: [] }],
  behaviors: [{ id: 'behaviors/pick.yaml', name: 'pick', icon: 'behavior', description: '', outcomes: [] }],
  entries: [],
} as unknown as CatalogueBody

it('draws each addition with the icon that the catalogue names', () => {
  live()
  useEditor.setState(blank('behaviors/shift.yaml'), true)
  setEditor({ catalogue: CATALOGUE })
  show(<LibraryPanel />)
  const icons = ['Add gripper.Grasp', 'Add State machine', 'Add pick'].map((name) =>
    screen.getByRole('button', { name }).querySelector('[data-icon]')?.getAttribute('data-icon'),
  )
  expect(icons).toEqual(['gripper', 'sitemap', 'behavior'])
})
