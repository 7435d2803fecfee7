/** Puts the page into the document. */
import '@fontsource-variable/inter/wght.css'
import '@mantine/core/styles.css'
import './styles/tokens.css'
import './styles/base.css'
import { MantineProvider } from '@mantine/core'
import { createRoot, type Root } from 'react-dom/client'
import { newQueryClient } from '../api/queryClient'
import { ViewBoundary } from '../components/ViewBoundary'
import { StopCell } from '../features/stop/StopCell'
import { App } from './App'
import { ServerAnswers } from './ServerAnswers'
import { theme } from './theme'

// STOP is a tree of its own: whatever fails in the page, it stays.
rootAt('stop').render(<StopCell />)
rootAt('root').render(
  <MantineProvider theme={theme} defaultColorScheme="auto">
    <ViewBoundary name="The page">
      <ServerAnswers client={newQueryClient()}>
        <App />
      </ServerAnswers>
    </ViewBoundary>
  </MantineProvider>,
)

function rootAt(id: string): Root {
  const element = document.getElementById(id)
  if (!element) throw new Error(`index.html has no #${id}`)
  return createRoot(element)
}
