/** Puts the page into the document. */
import '@fontsource-variable/inter/wght.css'
import '@mantine/core/styles.css'
import './styles/tokens.css'
import './styles/base.css'
import './styles/shared.css'
import { MantineProvider } from '@mantine/core'
import { createRoot, type Root } from 'react-dom/client'
import { ViewBoundary } from '../components/ViewBoundary'
import { StopCell } from '../features/stop/StopCell'
import { App } from './App'
import { theme } from './theme'

// STOP is a tree of its own: whatever fails in the page, it stays.
rootAt('stop').render(<StopCell />)
rootAt('root').render(
  <MantineProvider theme={theme} defaultColorScheme="auto">
    <ViewBoundary name="The page">
      <App />
    </ViewBoundary>
  </MantineProvider>,
)

function rootAt(id: string): Root {
  const element = document.getElementById(id)
  if (!element) throw new Error(`index.html has no #${id}`)
  return createRoot(element)
}
