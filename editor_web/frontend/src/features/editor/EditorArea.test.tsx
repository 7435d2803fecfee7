import { act, screen } from '@testing-library/react'
import { createRef } from 'react'
import { expect, it } from 'vitest'
import { show } from '../../../testing/page'
import { EditorArea } from './EditorArea'
import { setEditor } from './store'

it('says that the editor is busy, and draws nothing in it anew for that or for another selection', () => {
  let drawn = 0
  function Content() {
    drawn += 1
    return <p>content</p>
  }
  show(
    <EditorArea area={createRef()}>
      <Content />
    </EditorArea>,
  )
  const area = screen.getByText('content').closest('[data-editor]')
  expect(area?.getAttribute('aria-busy')).toBe('false')
  act(() => setEditor({ isBusy: true, selection: ['root/a'] }))
  expect(area?.getAttribute('aria-busy')).toBe('true')
  expect(drawn).toBe(1)
})
